#!/usr/bin/python3
"""again.py scans|poses TOOLS --first 1 --bodies 20 --times 10 --out SET
again.py spread POPULATION.jsonl - how much a woman's figures vary when she is measured again.

`scans` writes the same training women (TOOLS: the folder with make_set.py), each with `--times` booth scans that differ in sensors, noise,
place and clutter; `poses` writes surfaces of each in `--times` poses: arms 5 to 90 degrees, lean, twist, bend, legs. What is there stays.
`population --family SET --out POPULATION.jsonl` (poses: and --mesh-only) measures them; `spread` takes the standard deviation of each figure's
error over a woman's scans or poses, so what the truth itself varies by is taken off. Needs python3-numpy, python3-scipy.
"""
import argparse
import collections
import json
import os
import sys

import numpy as np


def write(kind, o):
    sys.path.insert(0, o.tools)
    import make_set
    import population
    model = make_set.BodyModel()
    os.makedirs(o.out, exist_ok=True)
    for seed in range(o.first, o.first + o.bodies):
        for k in range(o.times):
            name = 'T%04d_%02d' % (seed, k)
            if os.path.exists(os.path.join(o.out, name + '_truth.json')):
                continue
            rng = np.random.default_rng([make_set.KEYS['train'][0], seed])
            p = population.sample_parameters(rng, 'train')
            p['pose'], _ = population.sample_pose(rng, p['years'])
            again = np.random.default_rng([seed, k, 97])   # not a seed that make_set uses
            if kind == 'poses':
                p['pose'].update({'arm_' + s: float(5 + 85 * k / max(1, o.times - 1)) for s in 'LR'}, lean=float(again.normal(0, 6)),
                                 twist=float(again.normal(0, 4)), bend=float(again.normal(0, 3)), leg=float(again.uniform(-7, 6)))
            try:
                points, truth = make_set.true_body(model, p, name, '%s again' % kind)
            except (ValueError, IndexError):
                continue                                    # no measurable trunk
            base = os.path.join(o.out, name)
            s = make_set.sample_scan(again, 'any')
            points = make_set.move(truth, points, make_set.scan.rigid(s['yaw'], *s['tilt'], *s['shift'], 0.))
            make_set.write_body(base + '_body.ply', points, model.triangles, [name, 'MakeHuman CC0; metres, z up'])
            if kind == 'scans':
                x, truth['scan'] = make_set.scan_body(points, model.triangles, truth['landmarks'], s)
                make_set.scan.write_points(base + '_scan.ply', x, None, [name + ' simulated booth scan, metres, z up'])
            json.dump(make_set.rounded(truth), open(base + '_truth.json', 'w'))


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
    a.add_argument('what', choices=('scans', 'poses', 'spread'))
    a.add_argument('tools', help='the folder with make_set.py, or what population wrote')
    a.add_argument('--first', type=int, default=1)
    a.add_argument('--bodies', type=int, default=20)
    a.add_argument('--times', type=int, default=10)
    a.add_argument('--out', default='again')
    o = a.parse_args()
    spread(o.tools) if o.what == 'spread' else write(o.what, o)


if __name__ == '__main__':
    sys.exit(main())
