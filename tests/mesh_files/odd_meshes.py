#!/usr/bin/env python3
"""Odd mesh files, as booths deliver them, through `fit --scan`: each is measured or refused by name. The same body in other formats
must give the same measures, also through `fit --mesh`.

Each file is made of one body of the virtual booth, whose measures are known. With --table FILE all of them, as the table of
nodes/mesh_files/README.md; without it a few of each kind, as a test."""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np

import mesh_writers as write

LIMITS = {"bust": 9, "underbust": 9, "waist": 9, "hip": 9, "neck": 4}  # mm, ISO 20685, large and small girths
WALL = 0.002  # m, between the walls of a body made for printing
SAME = 0.1  # mm between the same body in another format
SEED = 20


def read_ply(path):
    """Of a binary PLY as the virtual booth writes it: vertices, faces."""
    head, data = path.read_bytes().split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.splitlines() if line.startswith(b"element")]
    vertices = np.frombuffer(data, "<f4", 3 * counts[0]).reshape(-1, 3).astype(float)
    rows = np.frombuffer(data, [("n", "u1"), ("v", "<i4", (3,))], counts[1], 12 * counts[0])
    return vertices, rows["v"].astype(int)


def used(vertices, faces):
    """Without vertices that no face has."""
    kept, places = np.unique(faces, return_inverse=True)
    return vertices[kept], places.reshape(faces.shape)


def middles(vertices, faces):
    return vertices[faces].mean(axis=1)


def where(test):
    return lambda v, f: used(v, f[test(middles(v, f))])


def pieces(v, f):
    """Cut into slabs of 25 cm whose edges do not share vertices."""
    slab = np.floor(middles(v, f)[:, 2] / 0.25).astype(int)
    parts = [used(v, f[slab == k]) for k in np.unique(slab)]
    starts = np.cumsum([0] + [len(p[0]) for p in parts])
    return np.vstack([p[0] for p in parts]), np.vstack([p[1] + s for p, s in zip(parts, starts)])


def gaps(v, f):
    """Cut into slabs with 4 mm between them."""
    return where(lambda m: m[:, 2] % 0.25 > 0.004)(v, f)


def open_edges(v, f):
    """One triangle in fifty is not there: some 6,000 open edges."""
    return v, f[np.random.default_rng(SEED).random(len(f)) > 0.02]


def holes(v, f):
    """Sixty round holes of 1 to 2 cm."""
    random = np.random.default_rng(SEED)
    m, keep = middles(v, f), np.ones(len(f), bool)
    for centre in m[random.integers(0, len(f), 60)]:
        keep &= np.linalg.norm(m - centre, axis=1) > random.uniform(0.005, 0.010)
    return used(v, f[keep])


def reversed_faces(share):
    def turned(v, f):
        which = np.random.default_rng(SEED).random(len(f)) < share
        g = f.copy()
        g[which] = g[which][:, ::-1]
        return v, g
    return turned


def reversed_pieces(v, f):
    """Every second slab of 25 cm is inside out."""
    which = np.floor(middles(v, f)[:, 2] / 0.25).astype(int) % 2 == 1
    g = f.copy()
    g[which] = g[which][:, ::-1]
    return v, g


def both(a, b):
    return np.vstack([a[0], b[0]]), np.vstack([a[1], b[1] + len(a[0])])


def normals(v, f):
    n = np.zeros_like(v)
    corners = v[f]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for k in range(3):
        np.add.at(n, f[:, k], area)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def double_walled(v, f):
    """A second surface 2 mm inside, inside out, as programs that prepare a print make it."""
    return both((v, f), (v - WALL * normals(v, f), f[:, ::-1]))


def fins(v, f):
    """Two hundred triangles that stand on edges: three faces at an edge."""
    at = np.random.default_rng(SEED).integers(0, len(f), 200)
    tips = middles(v, f)[at] + 0.004 * normals(v, f)[f[at][:, 0]]
    return np.vstack([v, tips]), np.vstack([f, np.column_stack([f[at][:, :2], len(v) + np.arange(200)])])


def debris(v, f):
    """A hundred crumbs of 1 cm around her."""
    random = np.random.default_rng(SEED)
    low, high = v.min(axis=0) - 0.4, v.max(axis=0) + 0.1
    corners = random.uniform(low, high, (100, 1, 3)) + random.normal(0, 0.005, (100, 3, 3))
    return both((v, f), (corners.reshape(-1, 3), np.arange(300).reshape(-1, 3)))


def floor_plate(v, f):
    """She stands on a plate of 1.6 m."""
    x, y = np.meshgrid(np.linspace(-0.8, 0.8, 41), np.linspace(-0.8, 0.8, 41))
    plate = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, v[:, 2].min())])
    at = np.arange(41 * 41).reshape(41, 41)
    corners = [at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]]
    a, b, c, d = (k.ravel() for k in corners)
    return both((v, f), (plate, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])))


def soup(v, f):
    """Each triangle has corners of its own."""
    return v[f].reshape(-1, 3), np.arange(f.size).reshape(-1, 3)


def split_in_four(v, f):
    """Four times as many triangles in the same place."""
    edges = np.sort(f[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    kept, place = np.unique(edges, axis=0, return_inverse=True)
    m = len(v) + place.reshape(-1, 3)
    g = [np.column_stack([f[:, 0], m[:, 0], m[:, 2]]), np.column_stack([f[:, 1], m[:, 1], m[:, 0]]),
         np.column_stack([f[:, 2], m[:, 2], m[:, 1]]), m]
    return np.vstack([v, v[kept].mean(axis=1)]), np.vstack(g)


def coarse(v, f):
    """Corners within 12 mm are one: some 8,000 triangles."""
    _, first, place = np.unique(np.floor(v / 0.012).astype(int), axis=0, return_index=True, return_inverse=True)
    g = place.reshape(-1)[f]
    return v[first], g[(g[:, 0] != g[:, 1]) & (g[:, 1] != g[:, 2]) & (g[:, 2] != g[:, 0])]


def spread_points(v, f):
    random = np.random.default_rng(SEED)
    corners = v[f]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    at = random.choice(len(f), 100000, p=area / area.sum())
    return np.einsum("nk,nkx->nx", random.dirichlet([1, 1, 1], len(at)), corners[at]), f


def rough(v, f):
    """Each vertex 1 mm off."""
    return v + np.random.default_rng(SEED).normal(0, 0.001, v.shape), f


def flat_faces(v, f):
    """Two thousand faces without area besides."""
    a = np.random.default_rng(SEED).integers(0, len(v), (2000, 2))
    return v, np.vstack([f, np.column_stack([a, a[:, :1]])])


def spare_vertices(v, f):
    """Twenty thousand vertices that no face has."""
    return np.vstack([v, np.random.default_rng(SEED).uniform(-1, 1, (20000, 3))]), f


def two_persons(v, f):
    return both((v, f), (v + [0.9, 0, 0], f))


def sphere(v, f):
    """Of her height."""
    middle = v.mean(axis=0)
    n = v - middle
    return 0.8 * n / np.linalg.norm(n, axis=1, keepdims=True), f


def not_a_number(v, f):
    bad = v.copy()
    bad[100, 1] = np.nan
    return bad, f


def no_faces(v, _):
    return v, np.zeros((0, 3), int)


def outside_indices(v, f):
    g = f.copy()
    g[7, 2] = 3 * len(v)
    return v, g


def moved(unit=1.0, up="z", yaw=0.0, by=(0, 0, 0), size=1.0):
    """In another unit (of a metre), with another axis up, turned and moved."""
    turns = {"z": np.eye(3), "y": np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), "x": np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
             "-z": np.diag([1, -1, -1])}

    def made(v, f):
        c, s = np.cos(yaw), np.sin(yaw)
        turned = size * v @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + by
        return turned @ turns[up].T / unit, f
    return made


def then(*steps):
    def made(v, f):
        for step in steps:
            v, f = step(v, f)
        return v, f
    return made


def as_it_is(v, f):
    return v, f


BOOTH = moved(unit=0.001, up="y")  # an OBJ as booths write it
# name, ending, writer, what is done to the body, what is expected (the same measures as the first, measured within limits, measured
# between two walls, a refusal's name), in the test
CASES = [
    ("PLY, m, z up", "ply", write.ply, as_it_is, "same", True),
    ("PLY, ASCII", "ply", write.ply_ascii, as_it_is, "same", False),
    ("OBJ, mm, y up", "obj", write.obj, BOOTH, "same", True),
    ("OBJ, inch, z up", "obj", write.obj, moved(unit=0.0254), "same", False),
    ("OBJ, with colours, texture, materials that lie elsewhere", "obj", write.obj_textured, BOOTH, "same", False),
    ("STL, cm, z up", "stl", write.stl, moved(unit=0.01), "same", True),
    ("STL, ASCII, mm, y up", "stl", write.stl_ascii, BOOTH, "same", False),
    ("STL that says ASCII and is binary", "stl", write.stl_that_says_ascii, BOOTH, "same", False),
    ("GLB, m, y up", "glb", write.glb, moved(up="y"), "same", True),
    ("XYZ, 100,000 points", "xyz", write.xyz, spread_points, "measured", False),
    ("XYZ, a mesh's vertices, which are close on hands and face alone", "xyz", write.xyz, as_it_is, "measured", False),
    ("lying on a side (x up), mm", "obj", write.obj, moved(unit=0.001, up="x"), "measured", False),
    ("upside down, STL, mm", "stl", write.stl, moved(unit=0.001, up="-z"), "measured", False),
    ("turned by 130 degrees, 3 m off the origin", "obj", write.obj, moved(0.001, "y", 2.27, (3, -2, 0.4)), "measured", False),
    ("seven pieces", "obj", write.obj, then(pieces, BOOTH), "measured", False),
    ("seven pieces with 4 mm between them", "stl", write.stl, then(gaps, BOOTH), "measured", False),
    ("seven pieces, every second inside out", "ply", write.ply, then(pieces, reversed_pieces), "measured", False),
    ("6,000 open edges", "obj", write.obj, then(open_edges, BOOTH), "measured", False),
    ("sixty holes of 1 to 2 cm", "ply", write.ply, holes, "measured", False),
    ("no crown", "obj", write.obj, then(where(lambda m: m[:, 2] < m[:, 2].max() - 0.05), BOOTH), "measured", False),
    ("no soles", "obj", write.obj, then(where(lambda m: m[:, 2] > 0.03), BOOTH), "measured", False),
    ("no crown, no soles, no hands", "stl", write.stl,
     then(where(lambda m: (m[:, 2] < m[:, 2].max() - 0.05) & (m[:, 2] > 0.02) & ((np.abs(m[:, 0]) < 0.3) | (m[:, 2] > 0.8))), BOOTH),
     "measured", False),
    ("all faces inside out", "ply", write.ply, reversed_faces(1.1), "measured", False),
    ("one face in ten inside out", "ply", write.ply, reversed_faces(0.1), "measured", False),
    ("each face twice", "obj", write.obj, then(lambda v, f: (v, np.vstack([f, f])), BOOTH), "measured", False),
    ("each face on both sides", "obj", write.obj, then(lambda v, f: (v, np.vstack([f, f[:, ::-1]])), BOOTH), "measured", False),
    ("a second wall 2 mm inside", "stl", write.stl, then(double_walled, BOOTH), "between", False),
    ("in pieces, no crown, 6,000 open edges, one face in ten inside out, each twice", "obj", write.obj,
     then(where(lambda m: m[:, 2] < m[:, 2].max() - 0.05), pieces, open_edges, reversed_faces(0.1), lambda v, f: (v, np.vstack([f, f])), BOOTH),
     "measured", True),
    ("three faces at 200 edges", "ply", write.ply, fins, "measured", False),
    ("triangles that share no vertex", "ply", write.ply, soup, "measured", False),
    ("2,000 faces without area", "obj", write.obj, then(flat_faces, BOOTH), "measured", False),
    ("2,000 faces without area, PLY", "ply", write.ply, flat_faces, "same", False),
    ("20,000 spare vertices", "obj", write.obj, then(spare_vertices, BOOTH), "measured", False),
    ("a hundred crumbs around her", "ply", write.ply, debris, "measured", False),
    ("on a plate", "ply", write.ply, floor_plate, "measured", False),
    ("8,000 triangles", "obj", write.obj, then(coarse, BOOTH), "measured", False),
    ("428,000 triangles", "glb", write.glb, then(split_in_four, moved(up="y")), "measured", False),
    ("each vertex 1 mm off", "stl", write.stl, then(rough, BOOTH), "measured", False),
    ("upper half alone, PLY", "ply", write.ply, where(lambda m: m[:, 2] > 0.72), "measured", False),
    ("upper half alone, OBJ, y up, without --up", "obj", write.obj, then(where(lambda m: m[:, 2] > 0.72), BOOTH), "not_a_body", False),
    ("as large as a doll, mm", "obj", write.obj, moved(0.001, "y", size=0.2), "not_a_body", False),
    ("as large as a house, m", "ply", write.ply, moved(size=6.5), "wrong_unit", True),
    ("two persons", "ply", write.ply, two_persons, "measured", False),
    ("a ball of 1.6 m", "obj", write.obj, then(sphere, BOOTH), "wrong_axes", False),
    ("a coordinate that is no number", "obj", write.obj, then(not_a_number, BOOTH), "non_finite", True),
    ("no faces", "obj", write.obj, then(no_faces, BOOTH), "bad_mesh", True),
    ("a face with a vertex that is not there", "ply", write.ply, outside_indices, "bad_mesh", False),
]


def fitted(programs, kind, file, folder):
    """The report of `fit --scan` or `--mesh`, whatever came of it."""
    done = subprocess.run([programs / "fit", kind, file, "--quiet", "--out", folder], capture_output=True, text=True, check=False,
                          timeout=300)
    if done.returncode not in (0, 3):
        raise RuntimeError(f"{file}: fit ended with {done.returncode}\n{done.stderr}")
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))


def apart(girths, reference):
    """mm between two readings, at most."""
    return max((1000 * abs(girths[name] - girth) for name, girth in reference.items() if name in girths), default=0)


def alike(report, reference):
    """Whether two reports have the same heights and girths."""
    return all(report[kind].keys() == reference[kind].keys() and apart(report[kind], reference[kind]) <= SAME for kind in ("heights", "girths"))


def read_as(report):
    return f"{report['scan']['unit']}, {report['scan']['axes']['up']} up"


def judged(report, expected, truth):
    """What came of a scan, in words, and whether it was expected."""
    if report["status"] == "refused":
        code = report["reason"]["code"].split(":")[0]
        return f"`{code}`: {pathlib.Path(report['reason']['message']).name}", code == expected
    girths = report["girths"]
    off = {name: 1000 * (girths[name] - truth[name]) for name in LIMITS if name in girths and name in truth}
    words = ", ".join(f"{name} {value:+.1f}" for name, value in off.items())
    missing = sorted(name for name in LIMITS if name in truth and name not in girths) + sorted(report["missing"])
    if missing:
        words += "; missing: " + ", ".join(missing)
    words += "".join("; " + thing["reason"] for thing in report["unexplained"] if thing["share"] > 0.1)
    lowest = 1000 * 2 * np.pi * WALL if expected == "between" else 0
    holds = expected in ("same", "measured", "between") and len(off) > 0
    return words, holds and all(-LIMITS[name] - lowest <= value <= LIMITS[name] for name, value in off.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("folder", type=pathlib.Path, help="for what is made on the way")
    parser.add_argument("--seed", type=int, default=7, help="of the body")
    parser.add_argument("--table", type=pathlib.Path, help="run all files and write this table")
    arguments = parser.parse_args()
    shutil.rmtree(arguments.folder, ignore_errors=True)
    subprocess.run([arguments.programs / "virtual_booth", "--seed", str(arguments.seed), "--points", "1000", "--out", arguments.folder],
                   check=True, stdout=subprocess.DEVNULL)
    body = read_ply(arguments.folder / "body.ply")
    truth = json.loads((arguments.folder / "truth.json").read_text(encoding="utf-8"))["girths"]
    rows, failed, as_scan, as_mesh = [], [], {}, {}
    for name, ending, writer, make, expected, in_test in CASES:
        if not arguments.table and not in_test:
            continue
        file = arguments.folder / f"odd.{ending}"
        file.write_bytes(writer(*make(*body)))
        report = fitted(arguments.programs, "--scan", file, arguments.folder / "fit")
        words, holds = judged(report, expected, truth)
        read, scans, meshes = "", "", ""
        if report["status"] == "ok":
            as_scan = as_scan or report["girths"]
            read, scans = read_as(report), f"{apart(report['girths'], as_scan):.2f}"
        if expected == "same":
            mesh = fitted(arguments.programs, "--mesh", file, arguments.folder / "fit")
            as_mesh = as_mesh or mesh
            holds = holds and alike(mesh, as_mesh) and apart(report["girths"], as_scan) <= SAME
            if name.endswith(" up"):  # the name says how it is to be read
                holds = holds and all(name.endswith(f", {how}") for how in (read, read_as(mesh)))
            meshes = f"{apart(mesh['girths'], as_mesh['girths']):.2f}"
        row = f"| {name} | {words} | {read} | {scans} | {meshes} |"
        print("ok   " if holds else "FAIL ", row, flush=True)
        rows.append(row)
        if not holds:
            failed.append(name)
    if arguments.table:
        head = ("| file | girths, mm off the truth; or refused | read as | from the first, mm | with `--mesh` |\n"
                "| --- | --- | --- | --- | --- |\n")
        arguments.table.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    if failed:
        sys.exit("not as expected: " + "; ".join(failed))


if __name__ == "__main__":
    main()
