#!/usr/bin/python3
"""booth_share.py SET POPULATION.jsonl - how much of what girths vary by, when a woman is scanned again, is the booth's own.

SET: what `again.py scans` wrote, POPULATION.jsonl: what `population` measured of it. Columns of a booth stand a little off, and each takes its
share of the skin with it: to first order a convex tape changes by the integral of the shift along its normal over the normal's angle. With the
shifts that the truth names this says, without any fit, what an exact reading of the cloud would be off by. A woman who moves while she is scanned
(`fracture`) is in the cloud twice. Standard deviations over a woman's scans in mm, median and most of the women. Needs python3-numpy, python3-scipy.
"""
import collections
import json
import pathlib
import sys

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, cKDTree

sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from meshes import read_ply, section

APART = 0.025  # m: points of a level section that far from all others are another limb's
TAPES = ('bust', 'underbust', 'waist', 'hip')
FEWEST = 3  # scans of a woman, for a deviation


def torso_tape(vertices, triangles, height):
    """Corners of the convex tape round the widest limb at a height, counterclockwise (n x 3)."""
    points = section(vertices, triangles, 2, height).reshape(-1, 2)
    tree = cKDTree(points)
    limb = connected_components(tree.sparse_distance_matrix(tree, APART), directed=False)[1]
    widest = max(set(limb), key=lambda i: np.ptp(points[limb == i], 0).max())
    points = points[limb == widest]
    corners = points[ConvexHull(points).vertices]
    return np.c_[corners, np.full(len(corners), height)]


def by_columns(tape, scan):
    """What the columns' shifts make of a tape's length, mm. Each corner moves as the columns that see it do in the mean, by the cosine."""
    settings = scan['settings']
    posts = settings['radius'] * np.exp(1j * np.radians(settings['start'] + 360 / settings['columns'] * np.arange(settings['columns'])))
    posts = np.stack([posts.real, posts.imag], 1)
    turns = np.radians([column['rot_deg'] for column in scan['column_misregistration']])
    shifts = np.array([column['t_mm'] for column in scan['column_misregistration']]) / 1000
    edges = np.roll(tape, -1, 0) - tape
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    corners = (angles - np.roll(angles, 1) + np.pi) % (2 * np.pi) - np.pi
    change = 0
    for point, angle, corner in zip(tape, angles, corners):
        normal = np.array([np.sin(angle - corner / 2), -np.cos(angle - corner / 2), 0])
        ways = posts - point[:2]
        seen = ways @ normal[:2] / np.linalg.norm(ways, axis=1)
        seen[seen < np.cos(np.radians(settings['max_angle']))] = 0
        if seen.sum() > 0:
            change += corner * normal @ (seen @ (shifts + np.cross(turns, point))) / seen.sum()
    return 1000 * change


def deviations(women, column, still):
    found = []
    for scans in women.values():
        values = [scan[column] for scan in scans if not still or not scan[2]]
        if len(values) >= FEWEST:
            found.append(np.std(values, ddof=1))
    return f'{np.median(found):.1f} {max(found):.1f} ({len(found)})' if found else ''


def main(folder, population):
    girths = collections.defaultdict(lambda: collections.defaultdict(list))
    for line in open(population):
        body = json.loads(line)
        truth = json.loads((folder / f"{body['body']}_truth.json").read_text())
        mesh = read_ply(folder / f"{body['body']}_body.ply")
        for figure in body['figures']:
            kind, _, name = figure['name'].partition(' ')
            if kind == 'girth' and name in TAPES and figure['counts'] and not figure['hidden'] and figure['error'] is not None:
                columns = by_columns(torso_tape(*mesh, truth['heights'][name]), truth['scan'])
                moved = truth['scan']['settings']['fracture'] is not None
                girths[name][body['body'].rsplit('_', 1)[0]].append((figure['error'], figure['error'] - columns, moved, columns))
    print('| girth | all scans | without the columns | she stood still | both |\n| --- | --- | --- | --- | --- |')
    for name, women in girths.items():
        print(f'| {name} |', ' | '.join(deviations(women, column, still) for still in (False, True) for column in (0, 1)), '|')
    for name, women in girths.items():
        apart = [np.array(s)[:, [0, 3]].astype(float) for s in women.values()]
        errors, columns = np.vstack([s - s.mean(0) for s in apart]).T
        print(f'{name}: correlation {np.corrcoef(errors, columns)[0, 1]:.2f}, slope {errors @ columns / (columns @ columns):.2f}')


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), sys.argv[2])
