#!/usr/bin/python3
"""again.py scans|poses|covered TOOLS --first 1 --bodies 20 --times 10 --out SET [--family validation]
again.py spread POPULATION.jsonl - how much a woman's figures vary when she is measured again.

`scans` writes the same training women (TOOLS: the folder with make_set.py), each with `--times` booth scans that differ in sensors, noise,
place and clutter; `poses` writes surfaces of each in `--times` poses: arms 5 to 90 degrees, lean, twist, bend, legs; `covered` writes surfaces
and scans of breasts whose nipples do not show, as under a bra: the skin round them (COVER) is the smoothest that joins the rest. What is there stays.
`population --family SET --out POPULATION.jsonl` (poses: and --mesh-only) measures them; `spread` takes the standard deviation of each figure's
error over a woman's scans or poses, so what the truth itself varies by is taken off. Needs python3-numpy, python3-scipy.
"""
import argparse
import collections
import json
import os
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

COVER = .022                                      # m round a bust point: three times the width of the bump that bust_point.cpp looks for


def without_nipples(points, triangles, nipples):
    """Round each nipple the surface of least bending (squared Laplacian) that goes on smoothly into the rest."""
    edges = np.unique(np.sort(np.vstack([triangles[:, [i, (i + 1) % 3]] for i in range(3)])), axis=0)
    near = scipy.sparse.coo_matrix((np.ones(2 * len(edges)), (np.r_[edges[:, 0], edges[:, 1]], np.r_[edges[:, 1], edges[:, 0]])), shape=2 * (len(points),)).tocsr()
    laplacian = scipy.sparse.diags(1 / np.maximum(np.asarray(near.sum(1)).ravel(), 1)) @ near - scipy.sparse.eye(len(points))
    bending = (laplacian @ laplacian).tocsc()
    free = np.min([np.linalg.norm(points - p, axis=1) for p in nipples], axis=0) < COVER
    a, b = bending[:, free], bending[:, ~free] @ points[~free]
    smooth = points.copy()
    smooth[free] = -scipy.sparse.linalg.splu((a.T @ a).tocsc()).solve(a.T @ b)
    return smooth


def onto(points, triangles, nipple):
    """Where a nipple would be on smooth skin: moved along that skin's mean normal, to the height of the vertices next to it."""
    corners = points[triangles]
    here = np.linalg.norm(corners.mean(1) - nipple, axis=1) < COVER
    normal = np.cross(corners[here, 1] - corners[here, 0], corners[here, 2] - corners[here, 0]).sum(0)
    normal /= np.linalg.norm(normal)
    off = points - nipple
    height = off @ normal
    aside = np.linalg.norm(off - np.outer(height, normal), axis=1)
    aside[np.abs(height) > COVER] = np.inf
    nearest = np.argsort(aside)[:4]
    return nipple + normal * np.average(height[nearest], weights=1 / (aside[nearest] + 1e-4))


def cover(points, triangles, truth):
    """Surface without nipples; the truth has the places below which they are, and no bust girth, as that went over them."""
    marks = truth['landmarks']
    names = ['bust_point_' + side for side in 'LR']
    smooth = without_nipples(points, triangles, [marks[n] for n in names])
    marks.update({n: onto(smooth, triangles, np.asarray(marks[n])) for n in names})
    truth['heights']['bust'] = float(np.mean([marks[n][2] for n in names]))
    truth['vague'] = sorted({*truth['vague'], 'girth bust'})
    return smooth


def write(kind, o):
    sys.path.insert(0, o.tools)
    import make_set
    import population
    model = make_set.BodyModel()
    os.makedirs(o.out, exist_ok=True)
    for seed in range(o.first, o.first + o.bodies):
        for k in range(o.times):
            name = '%s%04d_%02d' % (o.family[0].upper(), seed, k)
            if os.path.exists(os.path.join(o.out, name + '_truth.json')):
                continue
            rng = np.random.default_rng([make_set.KEYS[o.family][0], seed])
            p = population.sample_parameters(rng, o.family)
            p['pose'], _ = population.sample_pose(rng, p['years'])
            again = np.random.default_rng([seed, k, 97])   # not a seed that make_set uses
            if kind == 'poses':
                p['pose'].update({'arm_' + s: float(5 + 85 * k / max(1, o.times - 1)) for s in 'LR'}, lean=float(again.normal(0, 6)),
                                 twist=float(again.normal(0, 4)), bend=float(again.normal(0, 3)), leg=float(again.uniform(-7, 6)))
            try:
                points, truth = make_set.true_body(model, p, name, '%s again' % kind)
            except (ValueError, IndexError):
                continue                                    # no measurable trunk
            if kind == 'covered':
                points = cover(points, model.triangles, truth)
            base = os.path.join(o.out, name)
            s = make_set.sample_scan(again, 'any')
            points = make_set.move(truth, points, make_set.scan.rigid(s['yaw'], *s['tilt'], *s['shift'], 0.))
            make_set.write_body(base + '_body.ply', points, model.triangles, [name, 'MakeHuman CC0; metres, z up'])
            if kind != 'poses':
                x, truth['scan'] = make_set.scan_body(points, model.triangles, truth['landmarks'], s)
                make_set.scan.write_points(base + '_scan.ply', x, None, [name + ' simulated booth scan, metres, z up'])
            with open(base + '_truth.part', 'w') as out:      # its truth says that a body is whole
                json.dump(make_set.rounded(truth), out)
            os.rename(base + '_truth.part', base + '_truth.json')


def spread(path):
    errors = collections.defaultdict(list)
    for line in open(path):
        body = json.loads(line)
        for f in body['figures']:
            if f['counts'] and not f['hidden'] and f['error'] is not None:
                errors[f['name'], body['body'].rsplit('_', 1)[0]].append(f['error'])
    print('%-22s %6s %20s %8s' % ('figure', 'women', 'median deviation mm', 'most mm'))
    deviations = []
    for figure in sorted({k[0] for k in errors}):
        d = [np.std(v, ddof=1) for (f, _), v in errors.items() if f == figure and len(v) >= 3]
        if d:
            deviations += d
            print('%-22s %6d %20.2f %8.2f' % (figure, len(d), np.median(d), max(d)))
    print('median of all %.2f mm' % np.median(deviations))


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('what', choices=('scans', 'poses', 'covered', 'spread'))
    a.add_argument('tools', help='the folder with make_set.py, or what population wrote')
    a.add_argument('--first', type=int, default=1)
    a.add_argument('--bodies', type=int, default=20)
    a.add_argument('--times', type=int, default=10)
    a.add_argument('--family', choices=('train', 'validation'), default='train')
    a.add_argument('--out', default='again')
    o = a.parse_args()
    spread(o.tools) if o.what == 'spread' else write(o.what, o)


if __name__ == '__main__':
    sys.exit(main())
