#!/usr/bin/python3
"""train.py TRUTHS... --out MODEL - the statistical body model from random women of known shape.

TRUTHS: folders with NAME_truth.json (`parameters`, `landmarks`, `scan_from_body`) of training bodies; their skin is made anew from the
parameters and hm08.py. Components are principal components of the skin at rest, one stature for all, and its mirror image; each
vertex counts by its area. Format of MODEL: nodes/body_model/README.md. Needs python3-numpy, python3-scipy.
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

COMPONENTS = 60
STATURE = 1.70
FINGER_WEIGHT, FACE_WEIGHT = .05, .15             # of a vertex' area: how much hands and face count in the components
# How much skin counts in a fit: heads have hair, hands hold things, feet stand in the dark.
FIT_WEIGHT = dict(head=.15, upper_arm=.5, forearm=.5, hand=.25)
FIT_SPACING = dict(head=.028, trunk=.015, breast=.012, neck=.012, foot=.014)     # m between points; elsewhere:
LIMB_SPACING = .024
POSE_LIMBS = 'clavicle shoulder01 upperarm01 lowerarm01 wrist upperleg01 lowerleg01 foot'.split()
DRIVEN = ['root', 'spine05', 'spine04', 'spine03', 'spine02', 'spine01', 'neck01', 'neck02', 'neck03', 'head']
DRIVEN += ['%s.%s' % (b, s) for s in 'LR' for b in POSE_LIMBS]

# How far a joint turns, degrees about x (she bends forwards), y (sideways), z (twists): standard deviations. Poses that a booth has
# to take: lean or stoop of 25 degrees, arms from hanging to level, a step to the side.
# A raised arm takes the shoulder blade along by a third (Inman, Saunders, Abbott 1944: two degrees of arm for one of blade).
GROUPS = [('spine_low', [('spine05', .5), ('spine04', .5)], (8, 6, 6)),
          ('spine_high', [('spine03', .34), ('spine02', .33), ('spine01', .33)], (8, 6, 6)),
          ('neck', [('neck01', .4), ('neck02', .3), ('neck03', .3)], (12, 8, 8)),
          ('head', [('head', 1.)], (12, 8, 8))]
for _s in 'LR':
    GROUPS += [('clavicle_' + _s, [('clavicle.' + _s, 1.)], (4, 6, 4)),
               ('arm_' + _s, [('clavicle.' + _s, .08), ('shoulder01.' + _s, .27), ('upperarm01.' + _s, .65)], (25, 40, 25)),
               ('forearm_' + _s, [('lowerarm01.' + _s, 1.)], (30, 12, 20)),
               ('hand_' + _s, [('wrist.' + _s, 1.)], (15, 15, 15)),
               ('thigh_' + _s, [('upperleg01.' + _s, 1.)], (10, 8, 8)),
               ('shank_' + _s, [('lowerleg01.' + _s, 1.)], (8, 4, 4)),
               ('foot_' + _s, [('foot.' + _s, 1.)], (8, 8, 8))]
PARTS = ['head', 'neck', 'trunk', 'breast_L', 'breast_R', 'upper_arm_L', 'upper_arm_R', 'forearm_L', 'forearm_R', 'hand_L', 'hand_R',
         'thigh_L', 'thigh_R', 'shank_L', 'shank_R', 'foot_L', 'foot_R']
ACROMION = 8274                                   # vertex of hm08 over the left acromion, carried by the shoulder blade alone


def host(body, bone):
    """The driven bone that carries `bone`."""
    while bone not in DRIVEN:
        bone = body.parent[bone]
    return DRIVEN.index(bone)


def weights_of(body):
    """Skin weights by driven bone (vertices x bones), and by all of hm08's bones."""
    every = (body.smoothing @ body.skinning[:body.count]).toarray()
    driven = np.zeros((body.count, len(DRIVEN)))
    for j, bone in enumerate(body.weight_bones):
        driven[:, host(body, bone)] += every[:, j]
    return driven / driven.sum(1, keepdims=True), every


def four_weights(w):
    """The four largest weights of each vertex as bytes that sum to 255: (bones, weights)."""
    bones = np.argsort(-w, axis=1, kind='stable')[:, :4]
    share = np.take_along_axis(w, bones, 1)
    share /= share.sum(1, keepdims=True)
    byte = np.floor(255 * share).astype(int)
    byte[:, 0] += 255 - byte.sum(1)
    return bones.astype(np.uint8), byte.astype(np.uint8)


def parts_of(body, driven, every):
    """Part of the body at each vertex: that of its largest weight; breasts by hm08's own bones of them."""
    of_bone = {'head': 'head', 'neck01': 'neck', 'neck02': 'neck', 'neck03': 'neck', 'upperarm01': 'upper_arm', 'lowerarm01': 'forearm',
               'wrist': 'hand', 'upperleg01': 'thigh', 'lowerleg01': 'shank', 'foot': 'foot'}
    part = np.zeros(body.count, np.uint8)
    for v, b in enumerate(driven.argmax(1)):
        stem, _, side = DRIVEN[b].partition('.')
        name = of_bone.get(stem, 'trunk')
        part[v] = PARTS.index(name + '_' + side if side and name != 'trunk' else name)
    for side in 'LR':
        part[every[:, body.weight_bones.index('breast.' + side)] > .5] = PARTS.index('breast_' + side)
    return part


def quad_areas(points, quads):
    a = np.zeros(len(points))
    q = points[quads]
    np.add.at(a, quads.ravel(), np.repeat(np.linalg.norm(np.cross(q[:, 2] - q[:, 0], q[:, 3] - q[:, 1]), axis=1) / 8, 4))
    return a


def rest_shapes(body, truths):
    """Skin, then joints, of each body: (bodies, points, 3), pelvis joint at the origin, all of one stature."""
    out = []
    for t in truths:
        v = body.morph(t['parameters'])
        skin, joints = body.skin(v), body.joints(v, DRIVEN)
        out.append((np.vstack([skin, joints]) - joints[0]) * STATURE / np.ptp(skin[:, 2]))
    return np.array(out)


def fit_points(mean, part, hidden, spacing):
    """Vertices about `spacing(part)` apart that stand for the skin round them."""
    order = np.random.default_rng(1).permutation(len(mean))
    reach = np.array([spacing(PARTS[p]) for p in part])
    alive, tree, chosen = ~hidden, cKDTree(mean), []
    for v in order:
        if alive[v]:
            chosen.append(v)
            alive[tree.query_ball_point(mean[v], reach[v])] = False
    return np.sort(np.array(chosen, np.uint16))


def stands_for(mean, areas, chosen):
    """m^2 of skin that is nearest to each chosen vertex."""
    out = np.zeros(len(chosen))
    np.add.at(out, cKDTree(mean[chosen]).query(mean)[1], areas)
    return out


def inside_head(body, mean, part):
    """Mouth, eye sockets, nostrils: more than 10 mm inside the head's convex hull."""
    from scipy.spatial import ConvexHull
    head = np.where(part == PARTS.index('head'))[0]
    planes = ConvexHull(mean[head]).equations
    out = np.zeros(len(mean), bool)
    out[head] = -(mean[head] @ planes[:, :3].T + planes[:, 3]).max(1) > .010
    return out


def read_skin(path, count):
    """The first `count` vertices of a body's PLY: where hm08's own vertices lie."""
    raw = open(path, 'rb').read()
    start = raw.index(b'end_header\n') + 11
    return np.frombuffer(raw, '<f4', 3 * count, start).reshape(count, 3).astype(float)


def nearest_on_skin(point, points, triangles, tree):
    """(corners, barycentric coordinates) of the nearest point of a mesh; `tree` over the triangles' centroids."""
    best = None
    for t in tree.query(point, k=30)[1]:
        a, b, c = points[triangles[t]]
        u, v, w = b - a, c - a, point - a
        uu, uv, vv, wu, wv = u @ u, u @ v, v @ v, w @ u, w @ v
        d = uu * vv - uv * uv
        if d < 1e-18:
            continue
        s = np.array([0, (vv * wu - uv * wv) / d, (uu * wv - uv * wu) / d])
        s[0] = 1 - s[1] - s[2]
        s = np.maximum(s, 0) / np.maximum(s, 0).sum()                        # near enough to the edge's own nearest point
        far = np.linalg.norm(s @ points[triangles[t]] - point)
        if best is None or far < best[0]:
            best = far, triangles[t], s
    return best[1], best[2]


def neck_ring(truth, points, neck):
    """Front, back and sides of the neck's base: where the truth's plane meets the skin of neck and shoulders."""
    plane = truth['extra']['neck_plane']
    o, n = np.array(plane['origin']), np.array(plane['normal'])
    axes = np.linalg.inv(np.array(truth.get('scan_from_body', np.eye(4))))[:3, :3]
    d = (points - o) @ n
    ring = points[neck & (np.abs(d) < .012)] - o
    side = ring @ axes.T                                                     # body frame: x left, -y forward
    at = lambda v, w: o + ring[(side[:, :2] @ np.array(v) - 3 * np.abs(side[:, :2] @ np.array(w))).argmax()]
    return dict(neck_ring_front=at((0, -1), (1, 0)), neck_ring_back=at((0, 1), (1, 0)), neck_ring_L=at((1, 0), (0, 1)), neck_ring_R=at((-1, 0), (0, 1)))


SKIN_POINTS = ['bust_point_L', 'bust_point_R', 'crotch', 'neck_front', 'neck_back', 'neck_side_L', 'neck_side_R', 'navel', 'underbust_L', 'underbust_R']


def skin_points(body, files, truths, part, most=16):
    """Named points of the skin as weighted vertices: the mean of their places on the training bodies."""
    triangles = np.vstack([body.quads[:, [0, 1, 2]], body.quads[:, [0, 2, 3]]])
    neck = np.isin(part, [PARTS.index(p) for p in ('neck', 'trunk', 'head')])
    sums = {}
    for f, t in zip(files, truths):
        points = read_skin(f.replace('_truth.json', '_body.ply'), body.count)
        tree = cKDTree(points[triangles].mean(1))
        places = {k: np.array(t['landmarks'][k]) for k in SKIN_POINTS}
        places.update(neck_ring(t, points, neck))
        for name, p in places.items():
            corners, share = nearest_on_skin(p, points, triangles, tree)
            np.add.at(sums.setdefault(name, np.zeros(body.count)), corners, share)
    out = []
    for name, w in sums.items():
        ids = np.argsort(-w, kind='stable')[:most]
        ids = ids[w[ids] > .02 * w.sum()]
        out.append(dict(name=name, vertices=[[int(i), round(float(w[i] / w[ids].sum()), 4)] for i in ids]))
    return out


def write_model(path, header, arrays):
    kinds = {'float32': '<f4', 'int16': '<i2', 'int8': 'i1', 'uint16': '<u2', 'uint8': 'u1'}
    header['arrays'] = [dict(name=n, type=k, shape=list(a.shape)) for n, k, a in arrays]
    text = json.dumps(header, indent=1).encode()
    with open(path, 'wb') as out:
        out.write(b'tensegric_fit body model 1\n%d\n' % len(text) + text)
        for _, k, a in arrays:
            out.write(np.ascontiguousarray(a, kinds[k]).tobytes())


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('truths', nargs='+')
    a.add_argument('--out', required=True)
    o = a.parse_args()
    files = sorted(f for d in o.truths for f in glob.glob(os.path.join(d, '*_truth.json')))
    truths = [json.load(open(f)) for f in files]
    body = Hm08()
    n = body.count
    driven, every = weights_of(body)
    part = parts_of(body, driven, every)
    x = rest_shapes(body, truths)
    other_side = [DRIVEN.index(b[:-1] + {'L': 'R', 'R': 'L'}[b[-1]]) if b[-2:] in ('.L', '.R') else i for i, b in enumerate(DRIVEN)]
    swap = np.r_[body.mirror, n + np.array(other_side)]
    x = np.vstack([x, x[:, swap] * [-1, 1, 1]])
    mean = x.mean(0)
    fingers = sum(every[:, j] for j, b in enumerate(body.weight_bones) if b.startswith(('finger', 'metacarpal', 'toe')))
    importance = quad_areas(mean[:n], body.quads) * np.where(fingers > .3, FINGER_WEIGHT, np.where(part == PARTS.index('head'), FACE_WEIGHT, 1.))
    w = np.sqrt(np.r_[importance, np.full(len(DRIVEN), np.median(importance))])
    d = (x - mean).reshape(len(x), -1)
    weighted = d * np.repeat(w, 3)
    values, vectors = np.linalg.eigh(weighted @ weighted.T / len(x))
    values, vectors = values[::-1], vectors[:, ::-1][:, :COMPONENTS]
    basis = (vectors.T @ d / np.sqrt(len(x))).reshape(COMPONENTS, -1, 3)
    score = vectors * np.sqrt(len(x))
    left = d - score @ basis.reshape(COMPONENTS, -1)
    trunk = np.isin(part, [PARTS.index(p) for p in ('trunk', 'breast_L', 'breast_R')])
    residual = np.linalg.norm(left.reshape(len(x), -1, 3)[:, :n][:, trunk], axis=2)
    print('%d bodies; %d components keep %.3f %% of the variance; trunk: rms %.2f mm, 99 %% %.2f mm left' %
          (len(truths), COMPONENTS, 100 * values[:COMPONENTS].sum() / values.sum(), 1e3 * np.sqrt((residual ** 2).mean()), 1e3 * np.quantile(residual, .99)))

    acromion = np.stack([mean[[ACROMION, body.mirror[ACROMION]]]])[0], basis[:, [ACROMION, body.mirror[ACROMION]]]
    extra_mean = np.vstack([mean[n:], acromion[0]])
    extra_basis = np.concatenate([basis[:, n:], acromion[1]], 1)
    hidden = inside_head(body, mean[:n], part) | ((fingers > .2) & ~np.isin(part, [PARTS.index('foot_L'), PARTS.index('foot_R')]))
    kind = lambda p: p[:-2] if p[-2:] in ('_L', '_R') else p
    chosen = fit_points(mean[:n], part, hidden, lambda p: FIT_SPACING.get(kind(p), LIMB_SPACING))
    fit_weight = stands_for(mean[:n], quad_areas(mean[:n], body.quads) * ~hidden, chosen)
    fit_weight *= [FIT_WEIGHT.get(kind(PARTS[part[v]]), 1.) for v in chosen]
    print('%d fit points' % len(chosen))
    step = np.abs(basis[:, :n]).max((1, 2)) / 127
    bones, weight = four_weights(driven)
    header = dict(made=str(datetime.date.today()), bodies='%d training women of tools/bodies (%s to %s) and their mirror images' % (len(truths), truths[0]['name'], truths[-1]['name']),
                  licence='CC0 1.0: derived from MakeHuman hm08 and its targets', stature=STATURE,
                  bones=[dict(name=b, parent=-1 if i == 0 else host(body, body.parent[b])) for i, b in enumerate(DRIVEN)],
                  groups=[dict(name=g, bones=[[DRIVEN.index(b), s] for b, s in bs], spread=[round(np.radians(v), 5) for v in sd]) for g, bs, sd in GROUPS],
                  parts=PARTS, skin_points=skin_points(body, files[::7], truths[::7], part),
                  bone_points=[dict(name='acromion_' + s, bone=DRIVEN.index('shoulder01.' + s)) for s in 'LR'])
    write_model(o.out, header, [('mean', 'float32', mean[:n]), ('step', 'float32', step), ('basis', 'int8', np.rint(basis[:, :n] / step[:, None, None])),
                                ('extra_mean', 'float32', extra_mean), ('extra_basis', 'float32', extra_basis), ('quads', 'uint16', body.quads),
                                ('bones', 'uint8', bones), ('weights', 'uint8', weight), ('parts', 'uint8', part), ('fit_points', 'uint16', chosen), ('fit_weights', 'float32', fit_weight / fit_weight.max())])
    print('%.2f MB' % (os.path.getsize(o.out) / 1e6))


if __name__ == '__main__':
    sys.exit(main())
