#!/usr/bin/python3
"""fit_outside.py PRECISION --women MESH_READINGS SCAN_READINGS --mesh READINGS TRUTHS --scan READINGS TRUTHS

How far off figures are on bodies outside the body model's span. PRECISION is what fit_precision.py wrote of women; it is changed in place, what it
says of women is left as it is. READINGS and TRUTHS are as there, of women (training) and of bodies that the model was not made from and cannot make.
A body is outside by a share that rises from 0 at the misfit that 95 % of the women stay below (`span`, first number) to 1 at the median misfit of the others
(second number); that share of the deviation `outside` is added to each reading's own, as squares. It is fitted to the others' errors by likelihood, of Student's t
with 4 degrees of freedom. Needs python3-numpy, python3-scipy, python3-yaml.
"""
import argparse
import json
import re
import sys

import numpy as np
import yaml
from scipy.optimize import minimize_scalar

from fit_precision import COVERAGE, FEWEST, FREEDOM, LEAST, NORMAL, UNIT, limit, read_on_surfaces, reading_error, samples, settle

CONVENTIONAL = ('point navel',)  # the others have none: their truth is where their maker put it
MOST = .1    # m


def misfits(path):
    with open(path) as file:
        return np.array([r['residual'] for r in map(json.loads, file) if not r.get('cut')])


def outside_of(errors, inside, shares):
    """Likeliest deviation to add, m, to `inside`, m, of each error; 0 where it is none."""
    def loss(deviation):
        s = np.hypot(inside, shares * deviation)
        return np.mean(np.log(s) + (FREEDOM + 1) / 2 * np.log1p((errors / s) ** 2 / FREEDOM))
    best = minimize_scalar(loss, bounds=(0, MOST), method='bounded')
    return float(best.x) if best.fun < loss(0) and best.x > LEAST else 0.


def inside_of(known, row):
    return np.sqrt((known['base'] * (row.misfit / UNIT) ** known['growth']) ** 2 + (known['support'] * row.support) ** 2 + (known.get('shift', 0.) * row.shift) ** 2)


def with_outside(row, known, share):
    """The row's spreads of both readings for `settle`, of one row: what is added has no power and no slope."""
    fit = dict(growth=dict(mesh=0., model=0.))
    for key in ('mesh', 'model'):
        s = known[key]
        if s['base'] < MOST:
            fit[key] = np.array([np.hypot(inside_of(s, row), share * s.get('outside', 0.)), 0., s['bias'], 0.])
    return fit


def held(figure, rows, known, shares):
    """Share of the settled errors that their intervals hold, median error and half-width, m."""
    settled = [settle(r, dict(with_outside(r, known, w), limit=limit(figure))) for r, w in zip(rows, shares)]
    error = np.array([np.linalg.norm(e) for e, _, _, _ in settled])
    width = np.array([np.hypot(known['half_width_of_model' if resting else 'half_width'] * np.hypot(s, known['disagreement'] * apart), NORMAL * r.ground)
                      for r, (_, s, apart, resting) in zip(rows, settled)])
    return np.mean(error <= width), np.median(error), np.median(width)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('precision')
    a.add_argument('--women', nargs=2, required=True)
    a.add_argument('--mesh', nargs=2, required=True)
    a.add_argument('--scan', nargs=2, required=True)
    o = a.parse_args()
    with open(o.precision) as file:
        text = re.sub(r'^span: .*\n', '', re.sub(r', outside: [^}]*', '', file.read()), flags=re.M)
    precision, surfaces, names, spans = yaml.safe_load(text), read_on_surfaces(o.mesh[0]), set(), {}
    for source, women in zip(('mesh', 'scan'), o.women):
        span = spans[source] = np.quantile(misfits(women), COVERAGE), np.median(misfits(getattr(o, source)[0]))
        head, tail = text.split('\n%s:\n' % source)
        print('%s: span %.2f to %.2f mm' % (source, *(1e3 * s for s in span)))
        print('%-20s %4s %12s %12s %14s %9s %16s' % ('', 'n', 'mesh +mm', 'model +mm', 'held %', 'error mm', 'half-width mm'))
        for figure, rows in sorted(samples(*getattr(o, source), surfaces).items()):
            known = precision[source][figure]
            shares = np.clip((np.array([r.misfit for r in rows]) - span[0]) / (span[1] - span[0]), 0, 1)
            before = held(figure, rows, known, shares)
            names |= {r.body for r in rows}
            for key in ('mesh', 'model'):
                s, use = known[key], [k for k, r in enumerate(rows) if reading_error(r, key) is not None]
                s['outside'] = 0.
                if figure not in CONVENTIONAL and len(use) >= FEWEST and LEAST < s['base'] < MOST:  # it is read there, and not true by definition
                    bias = np.array([s['bias'], 0, 0])
                    errors = np.array([max(np.linalg.norm(reading_error(rows[k], key) - bias), LEAST) for k in use])
                    inside = np.array([inside_of(s, rows[k]) for k in use])
                    s['outside'] = outside_of(errors, inside, shares[use])
                tail = re.sub(r'^(  %s: .*?%s: \{[^}]*)' % (figure, key), lambda m, d=s['outside']: '%s, outside: %.3g' % (m.group(1), d), tail,
                              count=1, flags=re.M)
            after = held(figure, rows, known, shares)
            print('%-20s %4d %12.1f %12.1f %5.0f -> %4.0f %4.1f -> %4.1f %6.1f -> %5.1f' % (
                figure, len(rows), *(1e3 * known[k]['outside'] for k in ('mesh', 'model')), 100 * before[0], 100 * after[0], 1e3 * before[1], 1e3 * after[1],
                1e3 * before[2], 1e3 * after[2]))
        text = head + '\n%s:\n' % source + tail
    others = '%d others (%s to %s)' % (len(names), min(names), max(names))
    text = re.sub(r'^bodies: (.*?)(; outside the span .*)?$', lambda m: 'bodies: %s; outside the span %s\nspan: {mesh: [%.3g, %.3g], scan: [%.3g, %.3g]}' % (
        m.group(1), others, *spans['mesh'], *spans['scan']), text, count=1, flags=re.M)
    with open(o.precision, 'w') as file:
        file.write(text)


if __name__ == '__main__':
    sys.exit(main())
