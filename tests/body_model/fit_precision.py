#!/usr/bin/python3
"""fit_precision.py --mesh READINGS TRUTHS --scan READINGS TRUTHS --out precision.yaml

How far off each figure's readings on mesh and body model are, fitted to training bodies: READINGS as `readings` writes them (a line of
JSON per body), TRUTHS a folder with NAME_truth.json. READINGS with the model cut to fewer components stand for bodies outside its span: how
fast its errors grow with its misfit is fitted to them, too, and intervals, as women whom nobody tuned to are partly outside it. Figures that a truth calls vague take no part. What the truths measure by other
definitions (limbs, sides, gluteal folds) is true where it is read on the true surface. Needs python3-numpy, python3-scipy.

A reading's error has a Student-t distribution (4 degrees of freedom, so that a few gross errors do not rule) round a bias (of heights and
girths; of points 0), with the scale sqrt(base^2 + (slope * support)^2); the base grows with a power of the registration's residual (base: at 2 mm), on the mesh, too, as it is
looked for near where the model has it. What is
printed and written as `error` and `covered` is of bodies left out of the fit, in five parts.
"""
import argparse
import datetime
import json
import os
import sys

import numpy as np
from scipy.optimize import minimize

KINDS = ('point', 'height', 'girth')
FREEDOM = 4
COVERAGE = .95
GROSS_LIMITS = 3
GROSS = 4                                         # as in landmarks/figures.cpp
LEAST = 1e-4                                      # m: no reading is taken to be better
STEEPEST = 4                                      # power of the misfit: beyond it a few gross errors rule
UNIT = 2e-3                                       # m of misfit: as kUnit in landmarks/figures.cpp


OWN = ('upper_arm', 'thigh', 'hip_side', 'waist_side', 'gluteal_fold')  # read on the true surface


def is_own(name):
    return name.rsplit('_', 1)[0] in OWN


def read_on_surfaces(readings):
    """(body, figure) -> what is read on the true surface: points in the scan's frame."""
    out = {}
    for line in open(readings):
        r = json.loads(line)
        if r.get('cut'):
            continue
        frame = np.array(r['body_from_scan']).reshape(4, 4)
        for f in r['figures']:
            if is_own(f['name']) and 'mesh' in f:
                v = np.array(f['mesh'])
                out[r['name'], f['kind'], f['name']] = frame[:3, :3].T @ (v - frame[:3, 3]) if KINDS[f['kind']] == 'point' else v
    return out


def truth_of(truth, frame, kind, name):
    """True value in the body's frame of the reading (4x4 `frame`), the direction that it is loose along, or None."""
    if kind == 'point':
        p = truth['landmarks'].get(name)
        if p is None:
            return None
        loose = truth.get('loose', {}).get(name)
        return frame[:3, :3] @ np.array(p) + frame[:3, 3], None if loose is None else frame[:3, :3] @ np.array(loose)
    if kind == 'girth' and name == 'neck':
        return np.array([truth['girths'].get('neck_min', truth['girths']['neck']), 0, 0]), None  # one reading: the least girth
    v = truth[kind + 's'].get(name)
    return None if v is None else (np.array([v, 0, 0]), None)


def samples(readings, truths, own):
    """figure -> list of (error on mesh or None, error on model or None, support, residual): vectors in metres."""
    out = {}
    for line in open(readings):
        r = json.loads(line)
        path = os.path.join(truths, r['name'] + '_truth.json')
        if not os.path.exists(path):
            continue
        truth = json.load(open(path))
        vague = set(truth.get('vague', []))
        frame = np.array(r['body_from_scan']).reshape(4, 4)
        for f in r['figures']:
            kind, name = KINDS[f['kind']], f['name']
            if '%s %s' % (kind, name) in vague - {'girth neck', 'point neck_back'}:
                continue
            if is_own(name):
                v = own.get((r['name'], f['kind'], name))
                found = None if v is None else (frame[:3, :3] @ v + frame[:3, 3] if kind == 'point' else v, None)
            else:
                found = truth_of(truth, frame, kind, name)
            if found is None:
                continue
            value, loose = found

            def error(key):
                if key not in f:
                    return None
                e = np.array(f[key]) - value
                if loose is not None:
                    e = e - loose * (e @ loose) / (loose @ loose)
                return e
            key = '%s %s' % (kind, name[:-2] if name[-2:] in ('_L', '_R') else name)
            out.setdefault(key, []).append((error('mesh'), error('model'), f['support'], r['residual'], r['name'], bool(r.get('cut', 0)), f['seen']))
    return out


def scale(errors, base_of, support, biased):
    """base, slope and bias of |errors|, by likelihood."""
    e = np.array(errors)
    start = np.median(np.linalg.norm(e, axis=1) / base_of)

    def loss(q):
        s = np.hypot(np.exp(q[0]) * base_of, np.exp(q[1]) * support)
        size = np.linalg.norm(e - [q[2] * start * np.median(base_of) if biased else 0, 0, 0], axis=1)
        return np.mean(np.log(s) + (FREEDOM + 1) / 2 * np.log1p((size / s) ** 2 / FREEDOM)) + 1e-3 * (q[1] + 1) ** 2
    best = min((minimize(loss, (np.log(start), b, 0.), method='Nelder-Mead', options=dict(xatol=1e-3, fatol=1e-6, maxiter=2000)) for b in (-3., -1., 0.)), key=lambda m: m.fun)
    return np.array([max(np.exp(best.x[0]), LEAST / np.median(base_of)), np.exp(best.x[1]), best.x[2] * start * np.median(base_of) if biased else 0.])


def growth_of(rows, i):
    """Power of the misfit that errors of reading i (0 mesh, 1 model) grow with."""
    rows = [r for r in rows if r[i] is not None]
    if len(rows) < 20:
        return 0.
    e = np.array([max(np.linalg.norm(r[i]), LEAST) for r in rows])
    support, misfit = np.array([r[2] for r in rows]), np.log(np.array([r[3] for r in rows]) / UNIT)

    def loss(q):
        s = np.hypot(np.exp(q[0] + q[1] * misfit), np.exp(q[2]) * support)
        return np.mean(np.log(s) + (FREEDOM + 1) / 2 * np.log1p((e / s) ** 2 / FREEDOM)) + 1e-3 * (q[2] + 1) ** 2
    best = min((minimize(loss, (np.log(np.median(e)), 1., b), method='Nelder-Mead', options=dict(xatol=1e-3, fatol=1e-6, maxiter=2000)) for b in (-3., -1.)), key=lambda m: m.fun)
    return float(np.clip(best.x[1], 0., STEEPEST))


def spread(coefficients, base_of, support):
    return np.hypot(coefficients[0] * base_of, coefficients[1] * support)


def limit(figure):
    """What ISO 20685 allows, m."""
    kind, name = figure.split(' ', 1)
    if kind == 'point':
        return .005 if name == 'bust_point' else .010
    return .004 if kind == 'height' or name in ('neck', 'upper_arm') else .009


def settle(row, fit):
    """Settled error and its spread without and with disagreement: as landmarks/figures.cpp has it."""
    mesh, model = (None if e is None else e - [fit[k][2] if k in fit else 0, 0, 0] for e, k in zip(row, ('mesh', 'model')))
    support, residual = row[2:4]
    m, b = (spread(fit[k], (residual / UNIT) ** fit['growth'][k], support) if k in fit else None for k in ('mesh', 'model'))
    if mesh is None or m is None:
        return model, b, 0.
    if model is None or b is None:
        return mesh, m, 0.
    apart = np.linalg.norm(mesh - model)
    if not row[6] and apart > max(GROSS * np.hypot(m, b), GROSS_LIMITS * fit['limit']):
        return model, b, GROSS * b
    share = b * b / (m * m + b * b)
    return model + share * (mesh - model), m * np.sqrt(share), apart


def fitted(figure, rows):
    fit = dict(limit=limit(figure), growth=dict(mesh=growth_of(rows, 0), model=growth_of(rows, 1)))
    for i, key in ((0, 'mesh'), (1, 'model')):
        use = [r for r in rows if r[i] is not None and not r[5]]
        if len(use) >= 20 and not any(np.any(r[i]) for r in use):
            fit[key], fit['growth'][key] = np.array([LEAST, 0., 0.]), 0.
        elif len(use) >= 20:
            fit[key] = scale([r[i] for r in use], np.array([r[3] / UNIT for r in use]) ** fit['growth'][key], np.array([r[2] for r in use]), not figure.startswith('point'))
    e, s, apart = (np.array(v) for v in zip(*[(max(np.linalg.norm(a), LEAST), b, c) for a, b, c in (settle(r, fit) for r in rows)]))

    def loss(q):
        t = np.exp(q[1]) * np.hypot(s, np.exp(q[0]) * apart)
        return np.mean(np.log(t) + (FREEDOM + 1) / 2 * np.log1p((e / t) ** 2 / FREEDOM)) + 1e-3 * (q[0] + 2) ** 2
    fit['disagreement'] = float(np.exp(min((minimize(loss, (a, 0.), method='Nelder-Mead') for a in (-3., -1.)), key=lambda m: m.fun).x[0]))
    ratio = np.sort(e / np.hypot(s, fit['disagreement'] * apart))
    fit['half_width'] = float(np.interp(COVERAGE * (len(ratio) + 1) / len(ratio), (np.arange(len(ratio)) + 1) / len(ratio), ratio))
    return fit


def left_out(figure, rows, parts=5):
    """Errors (m), whether the interval holds them, its half-width, whether the model was cut: of bodies left out of the fit."""
    names = sorted({r[4] for r in rows})
    error, held, width, cut = [], [], [], []
    for k in range(parts):
        out = set(names[k::parts])
        train, test = [r for r in rows if r[4] not in out], [r for r in rows if r[4] in out]
        if len(train) < 20:
            continue
        fit = fitted(figure, train)
        for r in test:
            e, s, apart = settle(r, fit)
            error.append(np.linalg.norm(e))
            width.append(fit['half_width'] * np.hypot(s, fit['disagreement'] * apart))
            held.append(error[-1] <= width[-1])
            cut.append(r[5])
    return np.array(error), np.array(held), np.array(width), np.array(cut)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('--mesh', nargs=2, required=True)
    a.add_argument('--scan', nargs=2, required=True)
    a.add_argument('--out', required=True)
    o = a.parse_args()
    text, names, own = '', set(), read_on_surfaces(o.mesh[0])
    for source in ('mesh', 'scan'):
        text += '%s:\n' % source
        print('%-20s %4s %9s %9s %9s  cut; mesh, model: bias mm, base mm, growth, slope; disagreement' % (source, 'n', 'median mm', '95 % mm', 'covered'))
        for key, rows in sorted(samples(*getattr(o, source), own).items()):
            names |= {r[4] for r in rows if not r[5]}
            fit = fitted(key, rows)
            error, held, width, cut = left_out(key, rows)
            far = '%3.0f%% of %d' % (100 * np.mean(held[cut]), sum(cut)) if any(cut) else '-'
            error, held, width = error[~cut], held[~cut], width[~cut]
            m, b = fit.get('mesh'), fit.get('model')
            c = lambda v, growth: '{bias: %.5f, base: %.3g, growth: %.3g, support: %.3g}' % (v[2], v[0], growth, v[1]) if v is not None else '{bias: 0, base: 0.1, growth: 0, support: 0}'
            text += '  %s: {mesh: %s, model: %s, disagreement: %.3g, half_width: %.3g, error: %.2g, covered: %.3f, n: %d}\n' % (
                key, c(m, fit['growth']['mesh']), c(b, fit['growth']['model']), fit['disagreement'], fit['half_width'], np.median(error), held.mean(), len(error))
            print('%-20s %4d %9.2f %9.2f %8.1f%% %10s  %s  %s  %.2f   median half width %.2f mm' % (
                key, len(error), 1e3 * np.median(error), 1e3 * np.quantile(error, .95), 100 * held.mean(), far,
                *('-' if v is None else '%+.2f %.2f %.2f %.2f' % (1e3 * v[2], 1e3 * v[0], fit['growth'][k], v[1]) for k, v in (('mesh', m), ('model', b))), fit['disagreement'], 1e3 * np.median(width)))
    with open(o.out, 'w') as out:
        out.write('# How far off each figure may be: tests/body_model/fit_precision.py wrote this; error (m, median) and covered are of bodies left out.\n')
        out.write('made: %s\nbodies: %d training women (%s to %s)\n%s' % (datetime.date.today(), len(names), min(names), max(names), text))


if __name__ == '__main__':
    sys.exit(main())
