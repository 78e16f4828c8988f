#!/usr/bin/env python3
"""cut_scans.py SET OUT [--low 0.44] [--high 0.87] - scans of a booth that sees less of a woman.

SET: NAME_scan.ply and NAME_truth.json, as make_set.py writes them. Of each scan OUT gets the points nearer than 0.9 m to its middle and
between two heights (shares of her stature above the floor), and the truth without what nothing shows then: heights, crotch, and where the
head is cut off the neck. To be measured by `population --family OUT --totals`."""
import argparse
import json
import pathlib
import sys

import numpy as np

KINDS = {"float": "<f4", "float32": "<f4", "double": "<f8", "uchar": "u1", "uint8": "u1", "int": "<i4", "ushort": "<u2"}
NEAR = 0.9  # m: frame and clutter of the booth are farther
HEAD = 1.0  # shares of the stature: below it the head is cut off


def read(path):
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    fields = [(words[2], KINDS[words[1]]) for words in map(str.split, lines) if words[0] == "property"]
    return lines, np.frombuffer(body, np.dtype(fields), count)


def cut(path, out, low, high):
    truth = json.loads(path.with_name(path.name.replace("_scan.ply", "_truth.json")).read_text(encoding="utf-8"))
    lines, points = read(path)
    share = points["z"] / truth["heights"]["stature"]
    middle = [np.mean([place[axis] for place in truth["landmarks"].values()]) for axis in (0, 1)]
    kept = points[(share > low) & (share < high) & (np.hypot(points["x"] - middle[0], points["y"] - middle[1]) < NEAR)]
    header = [f"element vertex {len(kept)}" if line.startswith("element vertex") else line for line in lines]
    (out / path.name).write_bytes("\n".join(header + ["end_header\n"]).encode() + kept.tobytes())
    truth["vague"] = sorted({*truth["vague"], *(f"height {name}" for name in truth["heights"]), "point crotch"})
    if high < HEAD:
        for kind in ("girths", "landmarks"):
            truth[kind] = {name: value for name, value in truth[kind].items() if not name.startswith("neck")}
    (out / path.name.replace("_scan.ply", "_truth.json")).write_text(json.dumps(truth), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("set", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--low", type=float, default=0.44, help="statures: no legs")
    parser.add_argument("--high", type=float, default=0.87, help="statures: no head")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for path in sorted(arguments.set.glob("*_scan.ply")):
        cut(path, arguments.out, arguments.low, arguments.high)


if __name__ == "__main__":
    sys.exit(main())
