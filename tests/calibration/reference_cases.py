#!/usr/bin/python3
"""reference_cases.py DATA OUT [VARIANT...]: all finite-element references of DATA as `calibrate` reads them.

DATA has bodies in open/ and fem/bodies/, references in fem/ (NAME_VARIANT_rNNN.npz) and their tensions in fem/summary.json. Writes a CSV a
reference and OUT/cases.yaml. VARIANT: skin, hull (taut over the cleavage), strap, hip, hiphull (taut); all but hip where none is named: the
reference's skin band goes into the cleft between the buttocks. B1, H1: the shipped garment in place of skin's and hiphull's own band; string: B1 without
width; B1_taut: B1 as a taut band, in place of hull's; H1_sides: H1 ended at her sides, where skin carries it. Requests below 0.95 are left out: they are for looking at.
"""
import json
import pathlib
import sys

import reference_csv

GARMENTS = pathlib.Path(__file__).resolve().parents[2] / "launch" / "garments"
GARMENT = {"skin": "chest", "hull": "hull", "strap": "strap", "hip": "hip", "hiphull": "hiphull"}
SHIPPED = {"B1": "skin", "H1": "hiphull", "string": "skin", "B1_taut": "hull", "H1_sides": "hiphull"}  # garment -> the reference that it is compared with
CHANGED = {  # shipped garments with changes
    "string": ("B1", [("ratio:", "width: 0\n    ratio:")]),
    "B1_taut": ("B1", [("ratio:", "follow: taut\n    ratio:")]),
    "H1_sides": ("H1", [("hip_front_L, ", ""), (", hip_front_R", "")]),
}
USUAL = ("skin", "hull", "strap", "hiphull")
LEAST_REQUEST = 0.95


def garment_of(data, out, body, variant):
    """The garment's file. The taut band has the course of the one on the skin."""
    if variant in CHANGED:
        shipped, changes = CHANGED[variant]
        text = (GARMENTS / f"{shipped}.yaml").read_text()
        for old, new in changes:
            if old not in text:
                sys.exit(f"{shipped}.yaml has no '{old}': {variant} would be {shipped}")
            text = text.replace(old, new)
        (out / f"{variant}.yaml").write_text(text)
        return out / f"{variant}.yaml"
    if variant in SHIPPED:
        return GARMENTS / f"{variant}.yaml"
    path = data / "fem" / f"{body}_{GARMENT[variant]}.yaml"
    if variant != "hull":
        return path
    text = (data / "fem" / f"{body}_chest.yaml").read_text()
    taut = out / f"{body}_hull.yaml"
    taut.write_text(text.replace("follow: skin", "follow: taut"))
    return taut


def main(data, out, *variants):
    data, out = pathlib.Path(data).resolve(), pathlib.Path(out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    bodies = {}
    for entry in json.loads((data / "fem" / "summary.json").read_text()):
        body, variant, request = entry["body"], entry["variant"], entry["request"]
        wearing = [wanted for wanted in variants or USUAL if SHIPPED.get(wanted, wanted) == variant]
        if not wearing or request < LEAST_REQUEST:
            continue
        mesh = data / ("open" if body.startswith("F") else "fem/bodies") / f"{body}_body.ply"
        name = f"{body}_{variant}_r{round(1000 * request):03d}"
        reference_csv.main(mesh, data / "fem" / f"{name}.npz", out / f"{name}.csv")
        tension = entry["tension_N"]
        bodies.setdefault(body, (mesh, []))[1].extend(
            f"      - {{ratio: {request}, file: {name}.csv, garment: {garment_of(data, out, body, worn)}, "
            f"tension: {tension if isinstance(tension, list) else [tension]}}}\n" for worn in wearing)
    with open(out / "cases.yaml", "w") as file:
        file.write("bodies:\n")
        for body, (mesh, references) in sorted(bodies.items()):
            file.write(f"  - name: {body}\n    mesh: {mesh}\n    references:\n{''.join(references)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
