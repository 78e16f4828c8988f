#!/usr/bin/env python3
"""fit_without_feet.py FIT STANDING BODY.ply... - how far off the ground is that the model's soles give where a mesh has no feet.

Cuts each body's mesh above its feet, its shanks or its thighs, measures it with the program FIT, and compares the height of the bust with
that of the whole body: the surface there is the same, so what differs is the ground. Writes the root mean squares as `without_feet`
(thighs are there) and `without_thighs` into standing.yaml; prints each error, and how many lie within 1.96 of them with the body itself
left out."""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import meshes

CUTS = {'feet': (0.06, 0.11, 0.25, 0.31), 'thighs': (0.42, 0.46)}  # share of the stature


def write_ply(path, vertices, triangles):
    with open(path, 'w', encoding='utf-8') as file:
        file.write('ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n'
                   'element face %d\nproperty list uchar int vertex_indices\nend_header\n' % (len(vertices), len(triangles)))
        np.savetxt(file, vertices, '%.6f')
        np.savetxt(file, np.c_[np.full(len(triangles), 3), triangles], '%d')


def cut(vertices, triangles, height):
    kept = vertices[:, 2] > vertices[:, 2].min() + height
    number = np.cumsum(kept) - 1
    return vertices[kept], number[triangles[kept[triangles].all(axis=1)]]


def bust_height(fit, vertices, triangles):
    with tempfile.TemporaryDirectory() as folder:
        write_ply(folder + '/body.ply', vertices, triangles)
        if subprocess.run([fit, '--mesh', folder + '/body.ply', '--up', 'z', '--out', folder + '/out', '--quiet'], check=False, stdout=subprocess.DEVNULL).returncode != 0:
            return np.nan  # refused: nothing is said of its ground
        return json.loads(pathlib.Path(folder, 'out/report.json').read_text(encoding='utf-8'))['heights']['bust']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('fit')
    parser.add_argument('standing', type=pathlib.Path)
    parser.add_argument('bodies', nargs='+', type=pathlib.Path)
    arguments = parser.parse_args()
    errors = []
    for body in arguments.bodies:
        vertices, triangles = meshes.read_ply(body)
        whole = bust_height(arguments.fit, vertices, triangles)
        stature = np.ptp(vertices[:, 2])
        errors.append([[bust_height(arguments.fit, *cut(vertices, triangles, share * stature)) - whole for share in CUTS[what]] for what in CUTS])
        print(body.stem, *('%+.1f' % (1e3 * e) for cuts in errors[-1] for e in cuts), 'mm', flush=True)
    text = re.sub(r'^without_.*\n', '', arguments.standing.read_text(encoding='utf-8'), flags=re.MULTILINE)
    for k, what in enumerate(CUTS):
        own = np.array([of_body[k] for of_body in errors])  # body, cut
        held = [np.abs(own[i]) <= 1.96 * np.sqrt(np.nanmean(np.delete(own, i, 0) ** 2)) for i in range(len(own))]
        print('%s: root mean square %.1f mm, mean %+.1f mm; within 1.96 of it, left out: %.0f %%'
              % (what, 1e3 * np.sqrt(np.nanmean(own ** 2)), 1e3 * np.nanmean(own), 100 * np.mean(np.concatenate(held)[~np.isnan(own).ravel()])))
        text += 'without_%s: %.4f    # m; fit_without_feet.py, %d bodies cut at %d heights\n' % (
            what, np.sqrt(np.nanmean(own ** 2)), len(own), len(CUTS[what]))
    arguments.standing.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    sys.exit(main())
