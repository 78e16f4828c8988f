"""MakeHuman's hm08 female body (CC0): parameters -> skin at rest, joints, skinning weights.

`female.npz` beside this file holds the base mesh, targets, skeleton and weights. Inside it lengths are decimetres, y up, she
faces +z; everything that leaves this module is in metres, z up, facing -y, her left at +x.
"""
import os
import re

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))


def to_metres(points):
    """hm08's axes and unit -> metres, z up, facing -y."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], -1) * .1


def three_targets(value, names):
    """A slider 0..1 between a minimum, an average and a maximum target: [(name, weight)]."""
    low, high = max(0., 1 - 2 * value), max(0., 2 * value - 1)
    return [(n, w) for n, w in zip(names, (low, 1 - low - high, high)) if w > 1e-9]


class Hm08:
    def __init__(self, path=os.path.join(HERE, 'female.npz')):
        data = np.load(path)
        self.base = data['base_dm'].astype(float)
        self.quads = data['faces'].astype(int)
        self.count = int(data['n_body'])                                     # vertices of the skin; helpers follow
        self.bones = data['bones'].tolist()
        self.parent = dict(zip(self.bones, data['parents'].tolist()))
        self.head_ids = dict(zip(self.bones, np.split(data['head_ids'], data['head_start'][1:-1])))
        ids = data['target_delta'].astype(int).cumsum()
        offsets = data['target_offset'].T / 1000.
        first = data['target_start']
        self.targets = {n: (ids[a:b], offsets[a:b]) for n, a, b in zip(data['target_names'].tolist(), first[:-1], first[1:])}
        self.weight_bones = data['weight_bones'].tolist()
        self.skinning = self._skinning(data)
        self.mirror = cKDTree(self.base[:self.count]).query(self.base[:self.count] * [-1, 1, 1])[1]
        self.smoothing = self._limit_positions()

    def _skinning(self, data):
        """Vertices x bones, rows that sum to 1; what no bone holds goes with the root."""
        bone = np.repeat(np.arange(len(self.weight_bones)), np.diff(data['weight_start']))
        shape = (len(self.base), len(self.weight_bones))
        w = sparse.csr_matrix((data['weights'].astype(float), (data['weight_ids'].astype(int), bone)), shape).tolil()
        for v in np.where(np.asarray(w.sum(1)).ravel() == 0)[0]:
            w[v, self.weight_bones.index('root')] = 1
        w = w.tocsr()
        return sparse.diags(1 / np.asarray(w.sum(1)).ravel()) @ w

    def _limit_positions(self):
        """Matrix that takes the quad mesh's vertices to where one Catmull-Clark step moves them."""
        f, n = self.quads, self.count
        corner = sparse.csr_matrix((np.ones(f.size), (f.ravel(), np.repeat(np.arange(len(f)), 4))), (n, len(f)))
        centre = corner.T / 4
        edges = np.unique(np.sort(np.stack([f, np.roll(f, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
        k = np.arange(len(edges))
        at_edge = sparse.csr_matrix((np.ones(2 * len(k)), (edges.T.ravel(), np.r_[k, k])), (n, len(k)))
        middle = at_edge.T / 2
        valence = np.asarray(corner.sum(1)).ravel()
        share = sparse.diags(1 / valence)
        return (share @ (share @ corner @ centre + 2 * (share @ at_edge @ middle)) + sparse.diags((valence - 3) / valence)).tocsr()

    def _add(self, offsets, name, weight):
        ids, delta = self.targets[name]
        offsets[ids] += weight * delta

    def morph(self, p):
        """Vertices in dm of MakeHuman's sliders `p` (0..1; `mods` -1..1; p['L'], p['R'] override one side's breast)."""
        ages = [(a, w) for a, w in (('young', 2 - 2 * p['age']), ('old', 2 * p['age'] - 1)) if w > 0]
        muscle = three_targets(p['muscle'], ('minmuscle', 'averagemuscle', 'maxmuscle'))
        weight = three_targets(p['weight'], ('minweight', 'averageweight', 'maxweight'))
        builds = [('female-%s-%s-%s' % (a, m, g), wa * wm * wg) for a, wa in ages for m, wm in muscle for g, wg in weight]
        both = np.zeros_like(self.base)
        for age, w in ages:
            for race, share in zip(('caucasian', 'african', 'asian'), p['race']):
                if share:
                    self._add(both, 'macrodetails/%s-female-%s' % (race, age), w * share)
        for build, w in builds:
            self._add(both, 'macrodetails/universal-' + build, w)
            for folder, key, names in (('height', 'height', ('minheight', '', 'maxheight')),
                                       ('proportions', 'prop', ('uncommonproportions', '', 'idealproportions'))):
                for name, share in three_targets(p[key], names):
                    if name:
                        self._add(both, 'macrodetails/%s/%s-%s' % (folder, build, name), w * share)
        sides = [self._side(dict(p, **p.get(s, {}), mods=dict(p.get('mods', {}), **p.get(s, {}).get('mods', {}))), builds) for s in 'LR']
        blend = np.clip(self.base[:, 0] / .6 + .5, 0, 1)                     # over 3 cm each way
        blend = (blend * blend * (3 - 2 * blend))[:, None]
        return self.base + both + blend * sides[0] + (1 - blend) * sides[1]

    def _side(self, p, builds):
        out = np.zeros_like(self.base)
        cups = three_targets(p['cup'], ('mincup', 'averagecup', 'maxcup'))
        firmness = three_targets(p['firm'], ('minfirmness', 'averagefirmness', 'maxfirmness'))
        for build, w in builds:
            for cup, wc in cups:
                for firm, wf in firmness:
                    if (cup, firm) != ('averagecup', 'averagefirmness'):
                        self._add(out, 'breast/%s-%s-%s' % (build, cup, firm), w * wc * wf)
        for key, value in p.get('mods', {}).items():
            stem, low, high = re.match(r'(.*)-(\w+)\|(\w+)$', key).groups()
            self._add(out, '%s-%s' % (stem, high if value > 0 else low), abs(value))
        return out

    def skin(self, vertices):
        """Skin in metres, of `morph`'s vertices."""
        return to_metres(self.smoothing @ vertices[:self.count])

    def joints(self, vertices, bones):
        return to_metres(np.stack([vertices[self.head_ids[b]].mean(0) for b in bones]))
