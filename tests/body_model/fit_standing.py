#!/usr/bin/python3
"""fit_standing.py READINGS TRUTHS --standing standing.yaml - how women stand in scans: launch/body_model/standing.yaml.

READINGS: lines of JSON that `readings scan` wrote with that file; it is written anew. TRUTHS: a folder with NAME_truth.json. The error is
that of half of the bodies by what was fitted to the other half. Needs python3-numpy.
"""
import argparse
import datetime
import json
import os
import sys

import numpy as np

CLEARLY = 2.5                                        # deviations: as in nodes/body_model/standing.cpp


def of_body(r, truth, old):
    """Lean forwards and to the left (degrees), soles and lowest points above the ground (m), the latter None where a floor was seen."""
    scan_from_body = np.array(truth['scan_from_body'])
    up, origin = scan_from_body[:3, 2], scan_from_body[:3, 3]
    stance = {k: np.array(v) for k, v in r['stance'].items()}
    left = np.cross(stance['up'], stance['forward'])
    vertical, ground = np.array(r['vertical']), r['ground']
    above = vertical @ (stance['soles'] - origin)
    lowest = None
    if not truth['scan']['settings']['floor']:           # ground = (soles' ground + lowest - seen) / 2: see ground_under
        lowest = 2 * ground - (vertical @ stance['soles'] - old['soles'] * r['scale']) + old['seen'] - vertical @ origin
    lean = [np.degrees(np.arctan2(stance[k] @ (stance['up'] - up), 1)) if k else np.degrees(left @ (stance['up'] - up)) for k in ('forward', '')]
    return lean[0], lean[1], above / r['scale'], np.nan if lowest is None else lowest


def fit(rows):
    forwards, along, sideways = rows[:, 0].mean(), rows[:, 0].std(), rows[:, 1].std()
    # Leans have longer tails than a normal distribution: deviations such that one woman in 100 is CLEARLY off.
    wider = max(1, np.quantile(np.hypot((rows[:, 0] - forwards) / along, rows[:, 1] / sideways), .99) / CLEARLY)
    return dict(forwards=forwards, sideways=wider * sideways, along=wider * along, seen=np.nanmean(rows[:, 3]), soles=rows[:, 2].mean())


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('readings')
    a.add_argument('truths')
    a.add_argument('--standing', required=True)
    o = a.parse_args()
    old = {k: float(v.split('#')[0]) for k, v in (line.split(':') for line in open(o.standing)) if k in ('soles', 'seen', 'without_feet')}
    rows, names = [], []
    for line in open(o.readings):
        r = json.loads(line)
        rows.append(of_body(r, json.load(open(os.path.join(o.truths, r['name'] + '_truth.json'))), old))
        names.append(r['name'])
    rows = np.array(rows)
    halves = [fit(rows[k::2]) for k in (0, 1)]
    errors = np.concatenate([((rows[k::2, 2] - halves[1 - k]['soles']) + (rows[k::2, 3] - halves[1 - k]['seen'])) / 2 for k in (0, 1)])
    error = np.nanstd(errors)
    f = fit(rows)
    with open(o.standing, 'w') as out:
        out.write('# How women stand in scans: tests/body_model/fit_standing.py wrote this; the ground\'s error (m) is of bodies left out.\n')
        out.write('made: %s\nbodies: %d training women (%s to %s)\nerror: %.4f\n' % (datetime.date.today(), len(names), min(names), max(names), error))
        out.write('without_feet: %.4f    # m; fit_without_feet.py\n' % old['without_feet'])
        out.write('forwards: %.2f    # degrees\nsideways: %.2f    # degrees\nalong: %.2f    # degrees\nseen: %.4f    # m\nsoles: %.4f    # m\n' %
                  tuple(f[k] for k in ('forwards', 'sideways', 'along', 'seen', 'soles')))
    print(open(o.standing).read())


if __name__ == '__main__':
    sys.exit(main())
