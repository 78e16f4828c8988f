#!/usr/bin/python3
"""bones.py TRUTHS... --model MODEL --out BONES - an assumed rib cage and pelvis for the body model.

No scan sees bones. What is assumed: a woman's leanest twin, with the same age, stature and proportions, but fat, muscle and breasts at the
least that hm08 knows, wears her skin on her bones, as sliding calipers find it: skin and what they leave under their tips, INSET. On
average the twins' chests are 256 x 183 mm at bust level for a stature of 1.70 m; calipers read 269 x 183 mm on 260 women, scaled to
that stature (Heinz, Peterson, Johnson, Kerk: Exploring relationships in body dimensions. J. Statistics Education 11(2), 2003).
Breasts, arms, shoulder blades and buttocks are left out of the twins' skin, and bridged by the surface that bends least. Levels are those of
ANSUR II (Gordon et al. 2014, NATICK/TR-15/007: means of 6068 men and women) in shares of the stature. Between the ribs' arch, and between the
pelvis' crests in front, the surface stands for the wall of the belly.

TRUTHS: as for train.py. A bone's points are linear in the coefficients of MODEL; bones of the spine carry them. Format of BONES:
nodes/body_model/README.md. Needs python3-numpy, python3-scipy.
"""
import argparse
import datetime
import glob
import json
import os
import sys

import numpy as np
from scipy.spatial import cKDTree

from hm08 import Hm08
from train import DRIVEN, STATURE, four_weights, rest_shapes, weights_of

LEAN = dict(weight=0., muscle=0., cup=0., firm=.5, mods={}, L={}, R={})
INSET = .005                                      # m: skin of 2 mm (Southwood 1955), and as much again that calipers press flat
ANGLES, SPACING = 32, .025                        # points round a ring; m between rings, about what lies between points of a ring
TENTH_RIB, ILIAC_CREST, NECK_NOTCH, CROTCH = 1099.6 / 1714.4, 1040.1 / 1714.4, 1403.0 / 1714.4, 825.1 / 1714.4   # of the stature: ANSUR II
STERNUM = NECK_NOTCH - .16 / 1.63                  # lower end of the breastbone's body: 16 cm long, Gray's Anatomy
INLET = .05 / 1.63                                # half the width of the rib cage's upper opening, of the stature: Gray's Anatomy, 10 cm
BENDING = .1                                      # weight of a second difference against a point of the skin: bridges gaps, smooths by 1 mm
MOST_ARM, MOST_BREAST = .05, .02                  # share of skinning weight: more is no trunk
BUTTOCK = .16                                     # m to each side of the mid-plane: from the crests down, skin at the back lies on muscle, not bone
CLEFT = .012                                      # m: the midline, where it lies on the spine and the sacrum
BONES = [dict(name='rib_cage', low=TENTH_RIB, high=NECK_NOTCH, carried_by=['spine05', 'spine04', 'spine03', 'spine02', 'spine01'], placed_by=['spine03', 'spine02', 'spine01', 'neck01']),
         dict(name='pelvis', low=CROTCH, high=ILIAC_CREST, carried_by=['root'], placed_by=['root', 'upperleg01.L', 'upperleg01.R'])]


def checksum(path):
    """FNV-1a of 64 bits, as the product names its model."""
    value = 14695981039346656037
    for byte in open(path, 'rb').read():
        value = (value ^ byte) * 1099511628211 % (1 << 64)
    return '%016x' % value


def read_model(path):
    with open(path, 'rb') as f:
        f.readline()
        header = json.loads(f.read(int(f.readline())))
        kinds = {'float32': '<f4', 'int16': '<i2', 'int8': 'i1', 'uint16': '<u2', 'uint8': 'u1'}
        return {a['name']: np.frombuffer(f.read(int(np.prod(a['shape'])) * np.dtype(kinds[a['type']]).itemsize), kinds[a['type']]).reshape(a['shape']) for a in header['arrays']}


def trunk_vertices(body, every):
    """Skin of neither arm nor breast; the midline always, which lies on breastbone and spine."""
    share = lambda stems: sum(every[:, j] for j, b in enumerate(body.weight_bones) if b.split('.')[0].rstrip('0123456789-') in stems)
    limbs = share(('clavicle', 'shoulder', 'upperarm', 'lowerarm', 'wrist', 'metacarpal', 'finger', 'head', 'jaw'))
    middle = np.abs(body.base[:body.count, 0]) < 10 * CLEFT                  # dm
    return ((limbs < MOST_ARM) & (share(('breast',)) < MOST_BREAST)) | middle


def placed(own, twin, n, joints, midline):
    """A lean twin's skin where a woman's bone is: its joints at hers and, where `midline` is given (skin over breastbone and spine), leaning as
    her spine does; what she has more of over the two is shared evenly."""
    skin = twin[:n] + (own[joints] - twin[joints]).mean(0)
    if midline is not None:
        front, back = midline
        lean = np.polyfit(skin[back, 2], (own[back] - skin[back])[:, 1], 1)
        skin[:, 1] += np.polyval(lean, skin[:, 2])
        skin[:, 1] += (own[front] - skin[front])[:, 1].mean() / 2
    return skin


def midline_of(skin, trunk):
    """Vertices over the breastbone, and over the spine from the tenth rib up."""
    level = (skin[:, 2] - skin[:, 2].min()) / STATURE
    here = trunk & (np.abs(skin[:, 0]) < CLEFT) & (level < NECK_NOTCH) & (level > TENTH_RIB)
    front = skin[:, 1] < (skin[here, 1].min() + skin[here, 1].max()) / 2
    return np.where(here & front & (level > STERNUM))[0], np.where(here & ~front)[0]


def second_differences(rings):
    """Rows over the grid (rings x ANGLES): round each ring, along each column, and crossed."""
    at = lambda r, a: r * ANGLES + a % ANGLES
    rows = []
    for r in range(rings):
        for a in range(ANGLES):
            rows.append({at(r, a - 1): 1, at(r, a): -2, at(r, a + 1): 1})
            if 0 < r < rings - 1:
                rows.append({at(r - 1, a): 1, at(r, a): -2, at(r + 1, a): 1})
            if r < rings - 1:
                rows.append({at(r, a): 1.4, at(r, a + 1): -1.4, at(r + 1, a): -1.4, at(r + 1, a + 1): 1.4})
    d = np.zeros((len(rows), rings * ANGLES))
    for i, row in enumerate(rows):
        for j, w in row.items():
            d[i, j] = w
    return d


def bone_of(skin, trunk, bone, rings, stiffness):
    """Points (rings x ANGLES, 3) under a lean skin: radii about an upright axis that bend least between the skin's. Angle 0 is the front."""
    ground = skin[:, 2].min()
    low, high = ground + STATURE * bone['low'], ground + STATURE * bone['high']
    step = (high - low) / (rings - 1)
    here = trunk & (skin[:, 2] > low - step) & (skin[:, 2] < high + step)
    middle = here & (np.abs(skin[:, 0]) < CLEFT)
    axis = .5 * (skin[middle, 1].min() + skin[middle, 1].max())
    if bone['name'] == 'pelvis':
        here &= (skin[:, 1] < axis) | (np.abs(skin[:, 0]) > BUTTOCK) | (np.abs(skin[:, 0]) < CLEFT) | (skin[:, 2] > high - step)
    x, y, z = skin[here].T
    angle = np.arctan2(x, axis - y) / (2 * np.pi) * ANGLES
    level = np.clip((z - low) / step, 0, rings - 1 - 1e-9)
    radius = np.hypot(x, y - axis)
    if bone['name'] == 'rib_cage':
        angle, level, radius = np.r_[angle, ANGLES / 4, -ANGLES / 4], np.r_[level, 2 * [rings - 1 - 1e-9]], np.r_[radius, 2 * [STATURE * INLET + INSET]]
    a, r = np.floor(angle).astype(int), level.astype(int)
    u, v = angle - a, level - r
    d = np.zeros((len(a), rings * ANGLES))
    for da, dr, w in ((0, 0, (1 - u) * (1 - v)), (1, 0, u * (1 - v)), (0, 1, (1 - u) * v), (1, 1, u * v)):
        d[np.arange(len(a)), (r + dr) * ANGLES + (a + da) % ANGLES] = w
    found = np.linalg.solve(d.T @ d + stiffness, d.T @ radius).reshape(rings, ANGLES) - INSET
    t = 2 * np.pi * np.arange(ANGLES) / ANGLES
    return np.stack([found * np.sin(t), axis - found * np.cos(t), np.repeat(low + step * np.arange(rings)[:, None], ANGLES, 1)], -1).reshape(-1, 3)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('truths', nargs='+')
    a.add_argument('--model', required=True)
    a.add_argument('--out', required=True)
    o = a.parse_args()
    files = sorted(f for d in o.truths for f in glob.glob(os.path.join(d, '*_truth.json')))
    truths = [json.load(open(f)) for f in files]
    body = Hm08()
    driven, every = weights_of(body)
    trunk = trunk_vertices(body, every)
    model = read_model(o.model)
    x = rest_shapes(body, truths)
    lean = rest_shapes(body, [dict(parameters=dict(t['parameters'], **LEAN)) for t in truths])
    n = body.count
    basis = (model['basis'] * model['step'][:, None, None]).reshape(len(model['step']), -1).astype(float)
    offsets = np.vstack([x[:, :n], (x[:, :n] * [-1, 1, 1])[:, body.mirror]]) - model['mean']
    coefficients = np.linalg.solve(basis @ basis.T, basis @ offsets.reshape(len(offsets), -1).T).T
    header = dict(made=str(datetime.date.today()), model=checksum(o.model), bodies='%d training women of tools/bodies (%s to %s) and their mirror images' % (len(truths), truths[0]['name'], truths[-1]['name']),
                  licence='CC0 1.0: derived from MakeHuman hm08 and its targets', bones=[])
    arrays = []
    midline = midline_of(lean[:, :n].mean(0), trunk)
    for bone in BONES:
        rings = 1 + round(STATURE * (bone['high'] - bone['low']) / SPACING)
        bend = second_differences(rings)
        joints = [n + DRIVEN.index(b) for b in bone['placed_by']]
        points = []
        for own, twin in zip(x, lean):
            skin = placed(own, twin, n, joints, midline if bone['name'] == 'rib_cage' else None)
            points.append(bone_of(skin, trunk, bone, rings, BENDING * bend.T @ bend))
        points = np.array(points)
        other = np.arange(rings * ANGLES).reshape(rings, ANGLES)[:, (-np.arange(ANGLES)) % ANGLES].ravel()
        points = np.vstack([points, (points * [-1, 1, 1])[:, other]])
        design = np.c_[np.ones(len(coefficients)), coefficients]
        fit = np.linalg.solve(design.T @ design + np.diag([0.] + [1.] * len(basis)), design.T @ points.reshape(len(points), -1))   # coefficients are standard
        left = np.linalg.norm((points.reshape(len(points), -1) - design @ fit).reshape(points.shape), axis=2)
        mean, slopes = fit[0].reshape(-1, 3), fit[1:].reshape(-1, rings * ANGLES, 3)
        size = lambda f: np.ptp(mean[np.abs(mean[:, 2] - mean[0, 2] - f * (mean[-1, 2] - mean[0, 2])) < .013], axis=0)[:2] * 1e3
        print('%s: %d points; coefficients leave %.1f mm rms; width x depth of the mean at 10, 50, 90 %% of its height:' % (bone['name'], len(mean), 1e3 * np.sqrt((left ** 2).mean())), *('%.0f x %.0f' % tuple(size(f)) for f in (.1, .5, .9)))
        weights = np.isin(DRIVEN, bone['carried_by']) * 1.
        if len(bone['carried_by']) > 1:                                      # as they carry the trunk's skin nearest to each point
            weights = weights * driven
            inside = trunk & (weights.sum(1) > .5)
            weights = weights[inside][cKDTree(model['mean'][inside]).query(mean)[1]]
        by, share = four_weights(np.broadcast_to(weights, (len(mean), len(DRIVEN))))
        quads = [[r * ANGLES + i, r * ANGLES + (i + 1) % ANGLES, (r + 1) * ANGLES + (i + 1) % ANGLES, (r + 1) * ANGLES + i] for r in range(rings - 1) for i in range(ANGLES)]
        step = np.abs(slopes).max((1, 2)) / 127
        name = bone['name']
        header['bones'].append(dict(name=name))
        arrays += [(name + '_mean', 'float32', mean), (name + '_step', 'float32', step), (name + '_basis', 'int8', np.rint(slopes / step[:, None, None])),
                   (name + '_quads', 'uint16', np.array(quads)), (name + '_bones', 'uint8', by), (name + '_weights', 'uint8', share)]
    kinds = {'float32': '<f4', 'int8': 'i1', 'uint16': '<u2', 'uint8': 'u1'}
    header['arrays'] = [dict(name=m, type=k, shape=list(v.shape)) for m, k, v in arrays]
    text = json.dumps(header, indent=1).encode()
    with open(o.out, 'wb') as out:
        out.write(b'tensegric_fit bones 1\n%d\n' % len(text) + text)
        for _, k, v in arrays:
            out.write(np.ascontiguousarray(v, kinds[k]).tobytes())
    print('%.2f MB' % (os.path.getsize(o.out) / 1e6))


if __name__ == '__main__':
    sys.exit(main())
