#!/usr/bin/python3
"""fit_precision.py --mesh READINGS TRUTHS [READINGS TRUTHS] --scan READINGS TRUTHS [READINGS TRUTHS] [--booth READINGS TRUTHS]
    [--earlier PRECISION] --out precision.yaml
fit_precision.py --booth READINGS TRUTHS --earlier PRECISION --out precision.yaml
fit_precision.py --only FIGURE --mesh READINGS TRUTHS --earlier PRECISION --out precision.yaml

How far off each figure's readings on mesh and body model are, fitted to training bodies: READINGS as `readings` writes them (a line of
JSON per body), TRUTHS a folder with NAME_truth.json. READINGS with the model cut to fewer components stand for bodies outside its span: how
fast its errors grow with its misfit is fitted to them, too, or taken over from an earlier file (PRECISION), with what fit_outside.py added there. Figures that a truth calls vague take no part. What the truths measure by other
definitions (limbs, sides, gluteal folds) is true where it is read on the true surface. A second pair is of the same women with covered breasts (`again.py
covered`): what their nipples or a pointed breast would be moved by (`shift`) is fitted to both, and of the second no other figures are taken. Needs python3-numpy,
python3-scipy, python3-yaml.

Read on the true surface, a limb's girth still has the error of the tape's level and direction, which come from the registered model. Of women
nobody knows it. --booth has virtual bodies (`virtual_booth`), whose truths have limbs by our definition: from them limbs on meshes get their
errors, and their half-widths. How far off the model's own reading is stays as it is on women. With --booth, and without --mesh and --scan,
only these lines are made again; all others of PRECISION stay as they are. --only makes the line of one figure ("point axilla") on meshes again, after its
definition has changed.

A reading's error has a Student-t distribution (4 degrees of freedom, so that a few gross errors do not rule) round a bias (of heights and
girths; of points 0), with the scale sqrt(base^2 + (slope * support)^2 + (factor * shift)^2); the base grows with a power of the registration's residual (base: at 2 mm), on the mesh, too, as it is
looked for near where the model has it. Of heights what the ground was off by is taken off first: it is one error of all heights, its deviation is known
(Figure::ground), and it joins the interval afterwards. Half-widths, in spreads, are the quantile that holds 95 % of the settled errors of bodies left out of
the fit, in five parts, to which the whole model was registered: one for figures in which the mesh has a say, one for those that rest on the model. Where
there are fewer than 40 of them, bodies with the cut model are counted, too, and where that is not enough the figure has one half-width. `error` and `covered`
are of bodies left out, of the half-width, too.
"""
import argparse
import collections
import datetime
import json
import os
import re
import sys

import numpy as np
import yaml
from scipy.optimize import minimize

KINDS = ('point', 'height', 'girth')
FREEDOM = 4
COVERAGE = .95
GROSS_LIMITS = 3
GROSS = 4                                         # as in landmarks/figures.cpp
NEARLY_GROSS = .75                                # as there
NORMAL = 1.96                                     # as there: deviations that hold COVERAGE of normal errors
LEAST = 1e-4                                      # m: no reading is taken to be better
STEEPEST = 4                                      # power of the misfit: beyond it a few gross errors rule
UNIT = 2e-3                                       # m of misfit: as kUnit in landmarks/figures.cpp
KEPT = 'powers of the misfit'                     # what is taken over from an earlier file
FROM_BOOTH = 'limbs on meshes from '              # how the header's part on virtual bodies begins
FEWEST = 20                                       # readings that a spread is fitted to
FEWEST_HELD = 40                                  # errors that a half-width is the quantile of: two of them lie outside

# Errors are vectors in metres, None where there is no reading; `ground` is the deviation of the ground, `sunk` its error.
Row = collections.namedtuple('Row', 'mesh model support misfit body cut seen ground sunk shift')

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


def samples(readings, truths, surfaces):
    """figure -> list of Row. `surfaces`: what own figures are on the true surface; None: the truths have them by our definition."""
    out = {}
    for line in open(readings):
        r = json.loads(line)
        path = os.path.join(truths, r['name'] + '_truth.json')
        if not os.path.exists(path):
            continue
        truth = json.load(open(path))
        vague = set(truth.get('vague', []))
        frame = np.array(r['body_from_scan']).reshape(4, 4)
        ground = r.get('ground_deviation', 0.)
        sunk = (frame @ np.array(truth['scan_from_body'])[:, 3])[2] if ground > 0 and 'scan_from_body' in truth else 0.
        for f in r['figures']:
            kind, name = KINDS[f['kind']], f['name']
            if '%s %s' % (kind, name) in vague - {'girth neck', 'point neck_back'}:
                continue
            if is_own(name) and surfaces is not None:
                v = surfaces.get((r['name'], f['kind'], name))
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
            out.setdefault(key, []).append(Row(error('mesh'), error('model'), f['support'], r['residual'], r['name'].split('_')[0], bool(r.get('cut', 0)),
                                               f['seen'], *((ground, sunk) if kind == 'height' else (0., 0.)), f.get('shift', 0.)))
    return out


def reading_error(row, key):
    """The reading's error without the ground's."""
    e = getattr(row, key)
    return None if e is None else e - [row.sunk, 0, 0]


def scale(errors, base_of, support, biased, shift):
    """base, slope, bias and factor of |errors|, by likelihood; no factor (0) where no reading has a shift."""
    e = np.array(errors)
    start = np.median(np.linalg.norm(e, axis=1) / base_of)

    def loss(q):
        s = np.hypot(np.hypot(np.exp(q[0]) * base_of, np.exp(q[1]) * support), np.exp(q[3]) * shift if len(q) > 3 else 0)
        size = np.linalg.norm(e - [q[2] * start * np.median(base_of) if biased else 0, 0, 0], axis=1)
        return np.mean(np.log(s) + (FREEDOM + 1) / 2 * np.log1p((size / s) ** 2 / FREEDOM)) + 1e-3 * ((q[1] + 1) ** 2 + sum((q[3:] - 1) ** 2))
    best = min((minimize(loss, (np.log(start), b, 0.) + (1.,) * any(shift > 0), method='Nelder-Mead', options=dict(xatol=1e-3, fatol=1e-6, maxiter=4000)) for b in (-3., -1., 0.)),
               key=lambda m: m.fun)
    return np.array([max(np.exp(best.x[0]), LEAST / np.median(base_of)), np.exp(best.x[1]), best.x[2] * start * np.median(base_of) if biased else 0.,
                     np.exp(best.x[3]) if len(best.x) > 3 else 0.])


def growth_of(rows, key):
    """Power of the misfit that errors of the readings on `mesh` or `model` grow with."""
    rows = [r for r in rows if reading_error(r, key) is not None]
    if len(rows) < FEWEST:
        return 0.
    e = np.array([max(np.linalg.norm(reading_error(r, key)), LEAST) for r in rows])
    support, misfit = np.array([r.support for r in rows]), np.log(np.array([r.misfit for r in rows]) / UNIT)

    def loss(q):
        s = np.hypot(np.exp(q[0] + q[1] * misfit), np.exp(q[2]) * support)
        return np.mean(np.log(s) + (FREEDOM + 1) / 2 * np.log1p((e / s) ** 2 / FREEDOM)) + 1e-3 * (q[2] + 1) ** 2
    best = min((minimize(loss, (np.log(np.median(e)), 1., b), method='Nelder-Mead', options=dict(xatol=1e-3, fatol=1e-6, maxiter=2000)) for b in (-3., -1.)), key=lambda m: m.fun)
    return float(np.clip(best.x[1], 0., STEEPEST))


def spread(coefficients, base_of, support, shift):
    return np.hypot(np.hypot(coefficients[0] * base_of, coefficients[1] * support), coefficients[3] * shift)


def limit(figure):
    """What ISO 20685 allows, m."""
    kind, name = figure.split(' ', 1)
    if kind == 'point':
        return .005 if name == 'bust_point' else .010
    return .004 if kind == 'height' or name in ('neck', 'upper_arm') else .009


def settle(row, fit):
    """Settled error, its spread, and whether it rests on the model: as landmarks/figures.cpp has it."""
    mesh, model = (None if e is None else e - [fit[k][2] if k in fit else 0, 0, 0] for e, k in zip(row, ('mesh', 'model')))
    m, b = (spread(fit[k], (row.misfit / UNIT) ** fit['growth'][k], row.support, row.shift) if k in fit else None for k in ('mesh', 'model'))
    if mesh is None or m is None:
        return model, b, 0., True
    if model is None or b is None:
        return mesh, m, 0., False
    apart = np.linalg.norm(mesh - model)
    gross = max(GROSS * np.hypot(m, b), GROSS_LIMITS * fit['limit'])
    doubt = 0. if row.seen else np.clip((apart / gross - NEARLY_GROSS) / (1 - NEARLY_GROSS), 0., 1.)
    share = (1 - doubt) * b * b / (m * m + b * b)
    return model + share * (mesh - model), np.hypot(share * m, (1 - share) * b), apart if row.seen else min(apart, gross), doubt == 1


def fitted(figure, rows, growth, model=None):
    """Spreads of both readings, and what their distance counts. `growth`: of an earlier fit, or None.
    `model`: what `scale` gave for the model's reading, or None."""
    keys = ('mesh', 'model')
    fit = dict(limit=limit(figure), growth={k: growth_of(rows, k) if growth is None else growth[k]['growth'] for k in keys})
    for key in keys:
        use = [r for r in rows if reading_error(r, key) is not None and not r.cut]
        if key == 'model' and model is not None:
            fit[key] = model
        elif len(use) >= FEWEST and not any(np.any(getattr(r, key)) for r in use):
            fit[key], fit['growth'][key] = np.array([LEAST, 0., 0., 0.]), 0.
        elif len(use) >= FEWEST:
            fit[key] = scale([reading_error(r, key) for r in use], np.array([r.misfit / UNIT for r in use]) ** fit['growth'][key], np.array([r.support for r in use]),
                             not figure.startswith('point'), np.array([r.shift if key == 'mesh' else 0. for r in use]))
    use = [r for r in rows if not r.cut]
    settled = [settle(r, fit) for r in use]
    e = np.array([max(np.linalg.norm(error - [r.sunk, 0, 0]), LEAST) for r, (error, _, _, _) in zip(use, settled)])
    s, apart = (np.array(v) for v in list(zip(*settled))[1:3])

    def loss(q):
        t = np.exp(q[1]) * np.hypot(s, np.exp(q[0]) * apart)
        return np.mean(np.log(t) + (FREEDOM + 1) / 2 * np.log1p((e / t) ** 2 / FREEDOM)) + 1e-3 * (q[0] + 2) ** 2
    fit['disagreement'] = float(np.exp(min((minimize(loss, (a, 0.), method='Nelder-Mead') for a in (-3., -1.)), key=lambda m: m.fun).x[0]))
    return fit


def left_out(figure, rows, growth, model=None, parts=5):
    """Of bodies left out of the fit: errors, spreads and deviations of the ground (m), whether they rest on the model, whether it was cut, their part."""
    names, out = sorted({r.body for r in rows}), []
    for k in range(parts):
        part = set(names[k::parts])
        fit = fitted(figure, [r for r in rows if r.body not in part], growth, model)
        for r in rows:
            if r.body in part:
                e, s, apart, resting = settle(r, fit)
                out.append((max(np.linalg.norm(e), LEAST), np.hypot(s, fit['disagreement'] * apart), r.ground, resting, r.cut, k))
    return (np.array(v) for v in zip(*out))


def half_widths(error, deviation, ground, resting, cut):
    """Spreads whose interval, with the ground's, holds COVERAGE of further errors: where the mesh has a say, and where figures rest on the model."""
    ratio, found = np.sqrt(np.maximum(error ** 2 - (NORMAL * ground) ** 2, 0)) / deviation, []
    for group in (False, True):
        use = next(u for u in ((resting == group) & ~cut, resting == group, ~cut, cut | ~cut) if sum(u) >= FEWEST_HELD or u.all())
        held = np.sort(ratio[use])
        found.append(float(np.interp(COVERAGE * (len(held) + 1) / len(held), (np.arange(len(held)) + 1) / len(held), held)))
    return found


def line_of(key, rows, growth, model=None):
    """The figure's line of the file, printed with more. `growth`: its readings in an earlier file, or None; `model` as in `fitted`."""
    fit = fitted(key, rows, growth, model)
    *errors, part = left_out(key, rows, growth, model)
    error, deviation, ground, resting, cut = errors
    half_width, width = half_widths(*errors), np.zeros(len(error))
    for k in set(part):
        spreads = half_widths(*(v[part != k] for v in errors))
        width[part == k] = np.hypot(np.take(spreads, resting.astype(int)) * deviation, NORMAL * ground)[part == k]
    held = error <= width
    far = '%3.0f%% of %d' % (100 * np.mean(held[cut]), sum(cut)) if any(cut) else '-'
    error, held, width = error[~cut], held[~cut], width[~cut]
    m, b = fit.get('mesh'), fit.get('model')
    shift = lambda k: ', shift: %.3g' % fit[k][3] if k in fit and fit[k][3] else ''
    outside = lambda k: ', outside: %.3g' % growth[k]['outside'] if growth and 'outside' in growth[k] else ''
    c = lambda k: '{bias: %.5f, base: %.3g, growth: %.3g, support: %.3g%s%s}' % (
        *((fit[k][2], fit[k][0], fit['growth'][k], fit[k][1]) if k in fit else (0., .1, 0., 0.)), shift(k), outside(k))
    print('%-20s %4d %9.2f %9.2f %8.1f%% %10s  %s  %s  %.2f   median half width %.2f mm' % (
        key, len(error), 1e3 * np.median(error), 1e3 * np.quantile(error, .95), 100 * held.mean(), far,
        *('-' if v is None else '%+.2f %.2f %.2f %.2f' % (1e3 * v[2], 1e3 * v[0], fit['growth'][k], v[1]) for k, v in (('mesh', m), ('model', b))),
        fit['disagreement'], 1e3 * np.median(width)))
    return '  %s: {mesh: %s, model: %s, disagreement: %.3g, half_width: %.3g, half_width_of_model: %.3g, error: %.2g, covered: %.3f, n: %d}\n' % (
        key, c('mesh'), c('model'), fit['disagreement'], *half_width, np.median(error), held.mean(), len(error))


def booth_line(key, rows, growth, model):
    """The line of an own figure: its mesh reading's errors are those of virtual bodies; `growth` and `model` of its model reading are women's."""
    return line_of(key, rows, dict(growth, mesh=dict(growth['mesh'], growth=growth_of(rows, 'mesh'))), model)


def booth_part(booth):
    """What the header says of virtual bodies."""
    names = {r.body for rows in booth.values() for r in rows}
    return '%s%d virtual bodies (%s to %s), of %s' % (FROM_BOOTH, len(names), min(names), max(names), datetime.date.today())


def print_head(source):
    print('%-20s %4s %9s %9s %9s  cut; mesh, model: bias mm, base mm, growth, slope; disagreement' % (source, 'n', 'median mm', '95 % mm', 'covered'))


def with_booth(path, booth):
    """The text of an earlier file with the lines of own figures on meshes made again."""
    with open(path) as file:
        text = file.read()
    known = yaml.safe_load(text)['mesh']
    print_head('mesh')
    for key, rows in sorted(booth.items()):
        s = known[key]['model']
        line = booth_line(key, rows, known[key], np.array([s['base'], s['support'], s['bias'], s.get('shift', 0.)]))
        text = re.sub('^  %s: .*\n' % key, lambda m, line=line: line, text, count=1, flags=re.M)  # meshes come first
    return with_part(text, FROM_BOOTH, booth_part(booth))


def with_part(text, begins, part):
    """With that part in its header, in place of the one that begins so."""
    head = [p for p in re.search('^bodies: (.*)$', text, flags=re.M).group(1).split('; ') if not p.startswith(begins)]
    at = next((k for k, p in enumerate(head) if p.startswith(KEPT)), len(head))
    return re.sub('^bodies: .*$', lambda m: 'bodies: ' + '; '.join(head[:at] + [part] + head[at:]), text, count=1, flags=re.M)


def with_only(path, key, rows):
    """The text of an earlier file with one figure's line on meshes made again."""
    with open(path) as file:
        text = file.read()
    print_head('mesh')
    line = line_of(key, rows, yaml.safe_load(text)['mesh'][key])
    text = re.sub('^  %s: .*\n' % key, lambda m: line, text, count=1, flags=re.M)  # meshes come first
    names, begins = {r.body for r in rows}, key + ' on meshes from '
    return with_part(text, begins, '%s%d women (%s to %s), of %s' % (begins, len(names), min(names), max(names), datetime.date.today()))


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('--mesh', nargs='+')
    a.add_argument('--scan', nargs='+')
    a.add_argument('--booth', nargs=2, metavar=('READINGS', 'TRUTHS'), help='virtual bodies whose truths have the own figures by our definition')
    a.add_argument('--earlier')
    a.add_argument('--only', metavar='FIGURE')
    a.add_argument('--out', required=True)
    o = a.parse_args()
    if o.only:
        if not o.mesh or not o.earlier or o.scan or o.booth:
            a.error('--only needs --mesh and --earlier, and nothing else')
        text = with_only(o.earlier, o.only, samples(*o.mesh, read_on_surfaces(o.mesh[0]))[o.only])
        with open(o.out, 'w') as out:
            out.write(text)
        return
    booth = {key: rows for key, rows in samples(*o.booth, None).items() if key.split(' ')[1] in OWN} if o.booth else {}
    if not o.mesh and not o.scan and o.booth and o.earlier:
        text = with_booth(o.earlier, booth)
        with open(o.out, 'w') as out:
            out.write(text)
        return
    if not o.mesh or not o.scan:
        a.error('--mesh and --scan are needed, or --booth and --earlier')
    earlier = yaml.safe_load(open(o.earlier)) if o.earlier else None
    if earlier and FROM_BOOTH in earlier['bodies'] and not o.booth:
        a.error('%s has limbs from virtual bodies: --booth, or they are taken to be read without an error again' % o.earlier)
    kept = [p for p in earlier['bodies'].split('; ') if not p.startswith(FROM_BOOTH)][-1] if earlier else ''
    if earlier and not kept.startswith(KEPT):
        kept = '%s, and %s, of %s' % (KEPT, kept, earlier['made'])
    text, names, covered, surfaces = '', set(), set(), read_on_surfaces(o.mesh[0])
    for source in ('mesh', 'scan'):
        text += '%s:\n' % source
        print_head(source)
        files = getattr(o, source)
        women = samples(*files[:2], surfaces)
        for key, rows in samples(*files[2:], surfaces).items() if files[2:] else ():
            if any(r.shift > 0 for r in women.get(key, ())):
                women[key] += rows
                covered |= {r.body for r in rows}
        for key, rows in sorted(women.items()):
            names |= {r.body for r in rows if not r.cut}
            growth = earlier and earlier[source][key]
            if source == 'mesh' and key in booth:
                fit = fitted(key, rows, growth)
                powers = {k: dict(growth=fit['growth'][k], **({'outside': growth[k]['outside']} if growth else {})) for k in ('mesh', 'model')}
                text += booth_line(key, booth[key], powers, fit['model'])
            else:
                text += line_of(key, rows, growth)
    with open(o.out, 'w') as out:
        out.write('# How far off each figure may be: tests/body_model/fit_precision.py wrote this; error (m, median) and covered are of bodies left out.\n')
        out.write('made: %s\nbodies: %d training women (%s to %s)%s%s%s\n' % (
            datetime.date.today(), len(names), min(names), max(names), ', %d of them with covered breasts, too' % len(covered) if covered else '',
            '; ' + booth_part(booth) if booth else '', '; ' + kept if earlier else ''))
        if earlier:
            out.write('span: {mesh: [%g, %g], scan: [%g, %g]}\n' % (*earlier['span']['mesh'], *earlier['span']['scan']))
        out.write(text)


if __name__ == '__main__':
    sys.exit(main())
