#!/usr/bin/python3
"""worn_pairs.py DATA TOOLS OUT [--garment B1]: virtual pairs of scans, bare and worn, as `calibrate --worn` reads them.

DATA has bodies and finite-element displacements as reference_cases.py takes them; TOOLS: the folder with simulate_scan.py. A worn body is the bare
one with its chest displaced as the reference has it at a request of 0.95. Both are scanned, as in a booth (1 mm noise, columns 0.5 mm off), the worn
one turned and elsewhere. Writes OUT/NAME_bare.ply, OUT/NAME_worn.ply (clouds) and OUT/pairs.yaml. Without --garment the reference's own band.
"""
import argparse
import pathlib
import subprocess
import sys

import numpy as np

import reference_csv

REQUEST = 0.95
CHESTS = ["F0", "F1", "F2"] + ["T%02d" % n for n in range(1, 11)]


def write_displaced(body, field, out):
    """BODY.ply with its vertices moved: the header and the faces stay as they are."""
    data = body.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    vertices = reference_csv.read_ply(body)
    vertices[field["vertex"]] += field["disp_m"]
    header = data[:start].decode()
    lines = header.splitlines()
    count = next(int(s.split()[2]) for s in lines if s.startswith("element vertex"))
    names = []
    for line in lines[next(i for i, s in enumerate(lines) if s.startswith("element vertex")) + 1:]:
        if not line.startswith("property"):
            break
        names.append(line.split()[1:])
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "float32": "<f4", "float64": "<f8"}
    table = np.frombuffer(data, np.dtype([(n, kinds[k]) for k, n in names]), count, start).copy()
    for axis, name in enumerate("xyz"):
        table[name] = vertices[:, axis]
    out.write_bytes(data[:start] + table.tobytes() + data[start + table.nbytes:])


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("data", type=pathlib.Path)
    a.add_argument("tools", type=pathlib.Path)
    a.add_argument("out", type=pathlib.Path)
    a.add_argument("--garment")
    o = a.parse_args()
    o.data, o.out = o.data.resolve(), o.out.resolve()
    o.out.mkdir(parents=True, exist_ok=True)
    pairs = "bodies:\n"
    for seed, name in enumerate(CHESTS):
        body = o.data / ("open" if name.startswith("F") else "fem/bodies") / f"{name}_body.ply"
        displaced = o.out / f"{name}_displaced.ply"
        write_displaced(body, np.load(o.data / "fem" / f"{name}_skin_r{round(1000 * REQUEST)}.npz"), displaced)
        for state, source, place in (("bare", body, "0,0,0,0,0,0"), ("worn", displaced, "8,0.3,-0.4,0.04,-0.03,0")):
            cloud = o.out / f"{name}_{state}.ply"
            if not cloud.exists():
                subprocess.run([sys.executable, o.tools / "simulate_scan.py", source, cloud, "--seed", str(2 * seed + (state == "worn")), "--points", "120000",
                                "--sigma", "1", "--misreg", "0.5", f"--transform={place}"], check=True)
        garment = o.garment or o.data / "fem" / f"{name}_chest.yaml"
        pairs += f"  - {{name: {name}, scan: {name}_bare.ply, references: [{{ratio: {REQUEST}, garment: {garment}, worn_scan: {name}_worn.ply}}]}}\n"
    (o.out / "pairs.yaml").write_text(pairs)


if __name__ == "__main__":
    main()
