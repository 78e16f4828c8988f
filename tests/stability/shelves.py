#!/usr/bin/python3
"""Warnings of worn_skins against shelves that are found here, from the meshes alone.

A shelf: a square centimetre and more of skin (at rest) whose normal is turned by more than 60 degrees between BODY.ply
and BODY_GARMENT_PERCENT.ply. Writes a table of garments and ratios: shelves without a warning, warnings without a shelf.
"""
import argparse
import collections
import csv
import pathlib
import sys

import numpy as np

sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from meshes import read_ply

SHELF = 60  # degrees
FOLDS = {"shelf", "turned_over"}
WARNINGS = FOLDS | {"skin_crosses"}  # the other codes are notices


def area_vectors(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


def turned_area(rest, worn, triangles, least):
    """Area at rest, cm2, of the triangles whose normal is turned by more than `least` degrees."""
    before, after = area_vectors(rest, triangles), area_vectors(worn, triangles)
    areas = np.linalg.norm(before, axis=1)
    cosine = (before * after).sum(1) / np.maximum(areas * np.linalg.norm(after, axis=1), 1e-30)
    return 1e4 * areas[cosine < np.cos(np.radians(least))].sum()


def rows_of(run):
    """The table's rows that a run counts in."""
    garment, percent = run.split("_")[-2:]
    return (garment, percent), ("all", percent), ("all", "all")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="that worn_skins wrote")
    parser.add_argument("--least", type=float, default=1, help="cm2 of a shelf (default 1)")
    options = parser.parse_args()

    codes = collections.defaultdict(set)
    bodies, statuses = {}, {}
    table = collections.defaultdict(collections.Counter)
    with open(options.folder / "warnings.csv") as file:
        for row in csv.DictReader(file):
            if row["status"].startswith("refused"):  # there is no mesh
                for key in rows_of(row["run"]):
                    table[key].update(refused=1)
                continue
            codes[row["run"]].add(row["code"])
            bodies[row["run"]], statuses[row["run"]] = row["body"], row["status"]
    missed, idle = [], []
    rest = {}
    for run, body in bodies.items():
        if body not in rest:
            rest = {body: read_ply(options.folder / f"{body}.ply")}
        vertices, triangles = rest[body]
        worn, _ = read_ply(options.folder / f"{run}.ply")
        shelf = turned_area(vertices, worn, triangles, SHELF)
        is_shelf, is_warned = bool(shelf >= options.least), bool(codes[run] & FOLDS)
        for key in rows_of(run):
            table[key].update(runs=1, shelf=is_shelf, warned=is_warned, missed=is_shelf and not is_warned,
                              idle=is_warned and not is_shelf, turned_over="turned_over" in codes[run],
                              converged=statuses[run] == "converged",
                              quiet=statuses[run] == "converged" and not codes[run] & WARNINGS,
                              **{code: code in codes[run] for code in
                                 ("skin_turns", "over_stretched", "pressed_together", "under_constricted")})
        if is_shelf and not is_warned:
            missed.append(f"{run} ({shelf:.2f} cm2)")
        if is_warned and not is_shelf:
            idle.append(f"{run} ({shelf:.2f} cm2)")
    columns = ("runs", "refused", "converged", "quiet", "shelf", "warned", "missed", "idle", "turned_over", "skin_turns", "over_stretched",
               "pressed_together", "under_constricted")
    print("| garment | ratio |", " | ".join(columns), "|")
    print("| --- | --- |" + " --- |" * len(columns))
    for (garment, percent), counts in sorted(table.items(), key=lambda item: (item[0][0] == "all", item[0])):
        print(f"| {garment} | {percent} |", " | ".join(str(counts[column]) for column in columns), "|")
    total = table["all", "all"]
    print(f"\nShelves without a warning: {total['missed']} of {total['shelf']} {', '.join(missed)}")
    print(f"Warnings without a shelf: {total['idle']} of {total['warned']} {', '.join(idle)}")


if __name__ == "__main__":
    main()
