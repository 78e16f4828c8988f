#!/usr/bin/python3
"""reference_csv.py BODY.ply REFERENCE.npz OUT.csv: a displacement field as `calibrate` reads it.

REFERENCE.npz holds vertex (index into BODY.ply), disp_m (n x 3, metres) and fixed (1: held, not compared).
"""
import sys

import numpy as np


def read_ply(path):
    """Vertices of a binary PLY whose vertices begin with x, y, z as float or double."""
    with open(path, "rb") as file:
        kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "float32": "<f4", "float64": "<f8"}
        count, fields, in_vertex = 0, [], False
        while (line := file.readline().decode().split()) != ["end_header"]:
            if line[0] == "element":
                in_vertex = line[1] == "vertex"
                count = int(line[2]) if in_vertex else count
            elif line[0] == "property" and in_vertex:
                fields.append((line[2], kinds[line[1]]))
        vertices = np.frombuffer(file.read(count * np.dtype(fields).itemsize), fields, count)
    return np.stack([vertices[k].astype(float) for k in "xyz"], 1)


def main(body, reference, out):
    field = np.load(reference)
    rest = read_ply(body)[field["vertex"]]
    rows = np.c_[field["vertex"], rest, field["disp_m"], field["fixed"] != 0]
    np.savetxt(out, rows, fmt=["%d"] + ["%.9g"] * 6 + ["%d"], delimiter=",", header="vertex,x,y,z,dx,dy,dz,fixed", comments="")


if __name__ == "__main__":
    main(*sys.argv[1:])
