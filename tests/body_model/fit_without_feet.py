#!/usr/bin/env python3
"""fit_without_feet.py FIT STANDING BODY.ply... - how far off the ground is that the model's soles give where a mesh has no feet.

Cuts each body's mesh at three heights above its lowest place, measures it with the program FIT, and compares the height of the bust with
that of the whole body: the surface there is the same, so what differs is the ground. Writes the root mean square as `without_feet` into
standing.yaml; prints each error, and how many lie within 1.96 of it with the body itself left out."""
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

CUTS = (0.10, 0.30, 0.50)  # m: ankles, calves, above the knees


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
        subprocess.run([fit, '--mesh', folder + '/body.ply', '--out', folder + '/out', '--quiet'], check=True, stdout=subprocess.DEVNULL)
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
        errors.append([bust_height(arguments.fit, *cut(vertices, triangles, height)) - whole for height in CUTS])
        print(body.stem, *('%+.1f mm' % (1e3 * e) for e in errors[-1]), flush=True)
    errors = np.array(errors)
    deviation = np.sqrt((errors ** 2).mean())
    held = [np.abs(errors[i]) <= 1.96 * np.sqrt((np.delete(errors, i, 0) ** 2).mean()) for i in range(len(errors))]
    print('root mean square %.1f mm, mean %+.1f mm; within 1.96 of it, left out: %.0f %%' % (1e3 * deviation, 1e3 * errors.mean(), 100 * np.mean(held)))
    text = arguments.standing.read_text(encoding='utf-8')
    arguments.standing.write_text(re.sub(r'without_feet: .*', 'without_feet: %.4f    # m; fit_without_feet.py, %d bodies cut at %d heights'
                                         % (deviation, len(errors), len(CUTS)), text), encoding='utf-8')


if __name__ == '__main__':
    sys.exit(main())
