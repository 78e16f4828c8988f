#!/usr/bin/python3
"""recognise.py FIT BODY.ply OUT [WOMAN.ply ...] - what `fit` refuses and what it names.

Makes the strangers and halves of strangers.py from BODY (a training woman's true skin) in OUT, runs the program FIT
on each as a mesh, and on each WOMAN (true skin: as a mesh; a name with "scan": as a scan). Prints one line each and
what separates women from strangers. Exits 1 if a stranger is neither refused nor named, or a woman is refused or
lacks a limb. Needs python3-numpy, python3-scipy.
"""
import json
import os
import re
import subprocess
import sys

import strangers

MEASURED = re.compile(r'is ([\d.]+) m tall .*?, ([\d.]+) mm off .*?, ([\d.]+) deviations.*; ([\d.]+) % of the surface is not hers')


def fit(program, path, out):
    kind = '--scan' if 'scan' in os.path.basename(path) else '--mesh'
    done = subprocess.run([program, kind, path, '--out', out, '--quiet'], capture_output=True, text=True)
    if done.returncode not in (0, 3):
        sys.exit('%s: exit %d: %s' % (path, done.returncode, done.stderr))
    return json.load(open(os.path.join(out, 'report.json')))


def line_of(report):
    """What it says, and (stature m, misfit mm, shape, unexplained %) or None."""
    if report['status'] == 'refused':
        found = MEASURED.search(report['reason']['message'])
        words = report['reason']['message'].split(' (the most')[0]
        return '%s: %s' % (report['reason']['code'], words), found and [float(x) for x in found.groups()]
    model = report['body_model']
    words = ['missing %s (%s)' % item for item in report['missing'].items()]
    words += ['unexplained: ' + thing['reason'] for thing in report['unexplained']]
    words += [model['note']] if model['note'] else []
    return '; '.join(words), [model['stature'], 1e3 * model['misfit'], model['shape_deviation'], 100 * model['unexplained']]


PARTS = ('trunk', 'head', 'crown', 'upper_arm', 'forearm', 'hand', 'thigh', 'shank', 'foot')


def main():
    program, body, out, women = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    sys.argv[1:] = [body, out]
    strangers.main()
    made = sorted(n for n in os.listdir(out) if n.endswith('.ply'))
    wrong, numbers = [], {'women': [], 'halves': [], 'strangers': []}
    for path in [os.path.join(out, n) for n in made] + women:
        name = os.path.basename(path)[:-4]
        kind = 'women' if path in women else 'halves' if name.startswith('half_') else 'strangers'
        report = fit(program, path, os.path.join(out, 'fit'))
        words, measured = line_of(report)
        refused = report['status'] == 'refused'
        parts = [] if refused else [name for name in report['missing'] if name.startswith(PARTS)]  # not figures
        named = refused or parts or report['unexplained']
        if not named if kind != 'women' else refused or parts:
            wrong.append(name)
        if measured:
            numbers[kind].append((measured, name))
        print('| %s | %s |' % (name, words or 'measured'), '' if not measured else '%.2f m %.1f mm %.1f sd %.0f %%' % tuple(measured), flush=True)
    for kind, rows in numbers.items():
        for i, what in enumerate(('stature m', 'misfit mm', 'shape sd', 'unexplained %')):
            values = sorted(row[0][i] for row in rows)
            if values:
                print('%s (%d): %s %.2f to %.2f' % (kind, len(rows), what, values[0], values[-1]))
    if wrong:
        sys.exit('not as it should be: ' + ', '.join(wrong))


if __name__ == '__main__':
    main()
