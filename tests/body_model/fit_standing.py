#!/usr/bin/python3
"""fit_standing.py READINGS TRUTHS --standing standing.yaml [--legs | --facing] - how women stand in scans: launch/body_model/standing.yaml.

READINGS: lines of JSON that `readings scan` wrote with that file; it is written anew, or, with --legs, only what it says of legs alone, with --facing
only what it says of hips and feet (READINGS are those of `readings mesh`).
TRUTHS: a folder with NAME_truth.json. The error is that of half of the bodies by what was fitted to the other half. Needs python3-numpy.
"""
import argparse
import datetime
import json
import os
import re
import sys

import numpy as np

CLEARLY = 2.5                                        # deviations: in the middle between kUpright and kLeaning of nodes/body_model/standing.cpp


def of_body(r, truth, old):
    """Lean forwards and to the left (degrees), soles and lowest points above the ground (m), the latter None where a floor was seen or they
    were clearly apart from the soles, and the lean of the legs alone."""
    scan_from_body = np.array(truth['scan_from_body'])
    up, origin = scan_from_body[:3, 2], scan_from_body[:3, 3]
    stance = {k: np.array(v) for k, v in r['stance'].items()}
    left = np.cross(stance['up'], stance['forward'])
    vertical, ground = np.array(r['vertical']), r['ground']
    above = vertical @ (stance['soles'] - origin)
    lowest = None
    if r['ground_deviation'] == old['error']:            # ground = (soles' ground + lowest - seen) / 2: see ground_under
        lowest = 2 * ground - (vertical @ stance['soles'] - old['soles'] * r['scale']) + old['seen'] - vertical @ origin
    lean = [np.degrees(np.arctan2(stance[k] @ (stance['up'] - up), 1)) if k else np.degrees(left @ (stance['up'] - up)) for k in ('forward', '')]
    legs = stance['legs']
    pelvis = np.cross(stance['forward'], stance['up'])      # towards her right
    forward = np.cross(legs, pelvis) / np.linalg.norm(np.cross(legs, pelvis))
    of_legs = [np.degrees(axis @ (legs - up)) for axis in (forward, np.cross(legs, forward))]
    return lean[0], lean[1], above / r['scale'], np.nan if lowest is None else lowest, of_legs[0], of_legs[1]


def lean_of(ahead, aside):
    forwards, along, sideways = ahead.mean(), ahead.std(), aside.std()
    # Leans have longer tails than a normal distribution: deviations such that one woman in 100 is CLEARLY off.
    wider = max(1, np.quantile(np.hypot((ahead - forwards) / along, aside / sideways), .99) / CLEARLY)
    return dict(forwards=forwards, sideways=wider * sideways, along=wider * along)


def fit(rows):
    return dict(lean_of(rows[:, 0], rows[:, 1]), seen=np.nanmean(rows[:, 3]), soles=rows[:, 2].mean())


def line_of_legs(rows, names):
    legs = lean_of(rows[:, 4], rows[:, 5])
    print('legs alone: sideways %.2f, along %.2f; the deviations of soles and legs stand for them, too' % (legs['sideways'], legs['along']))
    return 'legs_forwards: %.2f    # degrees; %d training women (%s to %s)\n' % (legs['forwards'], len(names), min(names), max(names))


def line_of_facing(turns, names):
    deviation = max(np.sqrt(np.mean(np.square(turns))), np.quantile(np.abs(turns), .99) / CLEARLY)
    return 'facing: %.2f    # degrees; %d training women (%s to %s), meshes\n' % (deviation, len(names), min(names), max(names))


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('readings')
    a.add_argument('truths')
    a.add_argument('--standing', required=True)
    a.add_argument('--legs', action='store_true')
    a.add_argument('--facing', action='store_true')
    o = a.parse_args()
    old = {k: float(v.split('#')[0]) for k, v in (line.split(':') for line in open(o.standing)) if k in ('soles', 'seen', 'error')}
    text = open(o.standing).read()
    readings = [json.loads(line) for line in open(o.readings)]
    if o.facing:
        facing = line_of_facing([np.degrees(r['turn_of_feet']) for r in readings], [r['name'] for r in readings])
        with open(o.standing, 'w') as out:
            out.write(re.sub(r'^facing.*\n', '', text, flags=re.MULTILINE) + facing)
        return print(open(o.standing).read())
    rows, names = [], []
    for r in readings:
        rows.append(of_body(r, json.load(open(os.path.join(o.truths, r['name'] + '_truth.json'))), old))
        names.append(r['name'])
    rows = np.array(rows)
    kept = ''.join(re.findall(r'^(?:without_|facing).*\n', text, re.MULTILINE))  # fit_without_feet.py, --facing
    if o.legs:
        with open(o.standing, 'w') as out:
            out.write(re.sub(r'^legs_.*\n', '', text, flags=re.MULTILINE) + line_of_legs(rows, names))
        return print(open(o.standing).read())
    halves = [fit(rows[k::2]) for k in (0, 1)]
    errors = np.concatenate([((rows[k::2, 2] - halves[1 - k]['soles']) + (rows[k::2, 3] - halves[1 - k]['seen'])) / 2 for k in (0, 1)])
    error = np.nanstd(errors)
    f = fit(rows)
    with open(o.standing, 'w') as out:
        out.write('# How women stand in scans: tests/body_model/fit_standing.py wrote this; the ground\'s error (m) is of bodies left out.\n')
        out.write('made: %s\nbodies: %d training women (%s to %s)\nerror: %.4f\n' % (datetime.date.today(), len(names), min(names), max(names), error))
        out.write(kept)
        out.write('forwards: %.2f    # degrees\nsideways: %.2f    # degrees\nalong: %.2f    # degrees\nseen: %.4f    # m\nsoles: %.4f    # m\n' %
                  tuple(f[k] for k in ('forwards', 'sideways', 'along', 'seen', 'soles')))
        out.write(line_of_legs(rows, names))
    print(open(o.standing).read())


if __name__ == '__main__':
    sys.exit(main())
