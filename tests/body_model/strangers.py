#!/usr/bin/python3
"""strangers.py BODY.ply OUT - thirty meshes that are no woman and ten halves of one, for the recognition campaign.

BODY: a training woman's true skin (metres, z up, facing -y). Writes NAME.ply (non-bodies) and half_NAME.ply. Needs python3-numpy, python3-scipy.
"""
import os
import sys

import numpy as np
from scipy.spatial import ConvexHull


def read(path):
    raw = open(path, 'rb').read()
    end = raw.index(b'end_header\n') + 11
    head = raw[:end].decode().split('\n')
    count = {w[1]: int(w[2]) for w in (line.split() for line in head) if w[:1] == ['element']}
    v = np.frombuffer(raw, '<f4', 3 * count['vertex'], end).reshape(-1, 3).astype(float)
    f = np.frombuffer(raw, np.dtype([('n', 'u1'), ('v', '<i4', 3)]), count['face'], end + 12 * count['vertex'])['v'].astype(int)
    return v, f


def write(path, v, f):
    head = 'ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n'
    rows = np.zeros(len(f), np.dtype([('n', 'u1'), ('v', '<i4', 3)]))
    rows['n'], rows['v'] = 3, f
    with open(path, 'wb') as out:
        out.write((head % (len(v), len(f))).encode() + v.astype('<f4').tobytes() + rows.tobytes())


def grid(point, nu, nv, closed_u=False, closed_v=False):
    """Mesh of point(u, v), u and v from 0 to 1."""
    iu, iv = nu + (not closed_u), nv + (not closed_v)
    u, v = np.meshgrid(np.arange(iu) / nu, np.arange(iv) / nv, indexing='ij')
    p = np.stack(point(u.ravel(), v.ravel()), 1)
    a, b = np.meshgrid(np.arange(nu), np.arange(nv), indexing='ij')
    at = lambda i, j: ((i % iu) * iv + j % iv).ravel()
    q = [at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)]
    return p, np.vstack([np.stack([q[0], q[1], q[2]], 1), np.stack([q[0], q[2], q[3]], 1)])


def ellipsoid(a, b, c, centre=(0, 0, 0)):
    t = 2 * np.pi
    return grid(lambda u, v: (a * np.cos(t * u) * np.sin(np.pi * v) + centre[0], b * np.sin(t * u) * np.sin(np.pi * v) + centre[1], -c * np.cos(np.pi * v) + centre[2]), 60, 60, True)


def tube(a, b, r0, r1=None, n=40):
    """Capsule from a to b."""
    a, b = np.array(a, float), np.array(b, float)
    w = (b - a) / np.linalg.norm(b - a)
    u = np.cross(w, [1, 0, 0] if abs(w[0]) < .9 else [0, 1, 0])
    u /= np.linalg.norm(u)
    v = np.cross(w, u)
    r1 = r0 if r1 is None else r1

    def point(s, t):
        cap = np.clip(np.abs(t - .5) * 2 - .8, 0, 1) / .2
        along = np.clip((t - .1) / .8, 0, 1)
        r = (r0 + (r1 - r0) * along) * np.sqrt(np.maximum(1 - cap ** 2, 1e-6))
        end = np.sign(t - .5) * cap * (r0 + (r1 - r0) * along)
        p = a + np.outer(along, b - a) + np.outer(end, w) + (r * np.cos(2 * np.pi * s))[:, None] * u + (r * np.sin(2 * np.pi * s))[:, None] * v
        return p[:, 0], p[:, 1], p[:, 2]
    return grid(point, n, n, True)


def box(lo, hi, n=24):
    lo, hi = np.array(lo, float), np.array(hi, float)
    parts = []
    for axis in range(3):
        for end in (0, 1):
            def point(u, v, axis=axis, end=end):
                p = np.zeros((len(u), 3))
                i, j = [k for k in range(3) if k != axis]
                p[:, axis], p[:, i], p[:, j] = end, u, v
                p = lo + p * (hi - lo)
                return p[:, 0], p[:, 1], p[:, 2]
            q, f = grid(point, n, n)
            normal = np.cross(q[f[0, 1]] - q[f[0, 0]], q[f[0, 2]] - q[f[0, 0]])[axis]
            parts.append((q, f if (normal > 0) == (end == 1) else f[:, ::-1]))
    return merged(parts)


def merged(parts):
    v, f, n = [], [], 0
    for p, t in parts:
        v.append(p)
        f.append(t + n)
        n += len(p)
    return np.vstack(v), np.vstack(f)


def moved(mesh, shift=(0, 0, 0), turn=None):
    v, f = mesh
    return (v if turn is None else v @ np.array(turn).T) + shift, f


def kept(mesh, keep):
    """Triangles whose corners are all kept."""
    v, f = mesh
    f = f[keep[f].all(1)]
    used = np.unique(f)
    index = np.full(len(v), -1)
    index[used] = np.arange(len(used))
    return v[used], index[f]


def about_x(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return [[1, 0, 0], [0, c, -s], [0, s, c]]


def about_z(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return [[c, -s, 0], [s, c, 0], [0, 0, 1]]


def main():
    body, out = read(sys.argv[1]), sys.argv[2]
    os.makedirs(out, exist_ok=True)
    v, f = body
    v = v - [np.median(v[:, 0]), np.median(v[:, 1]), v[:, 2].min()]
    body, top = (v, f), v[:, 2].max()
    rng = np.random.default_rng(1)
    dog = merged([ellipsoid(.45, .16, .18, (0, 0, .55)), ellipsoid(.16, .11, .12, (.58, 0, .8)), tube((.45, 0, .62), (.55, 0, .8), .08)] +
                 [tube((x, y, .5), (x, y, .03), .05) for x in (-.3, .3) for y in (-.1, .1)] + [tube((-.45, 0, .6), (-.7, 0, .85), .03)])
    chair = merged([box((-.22, -.22, .43), (.22, .22, .47)), box((-.22, .20, .47), (.22, .23, 1.0))] + [box((x - .02, y - .02, 0), (x + .02, y + .02, .43)) for x in (-.2, .2) for y in (-.2, .2)])
    table = merged([box((-.6, -.4, .70), (.6, .4, .75))] + [box((x - .03, y - .03, 0), (x + .03, y + .03, .7)) for x in (-.5, .5) for y in (-.3, .3)])
    ring = grid(lambda a, b: ((.6 + .15 * np.cos(2 * np.pi * b)) * np.cos(2 * np.pi * a), (.6 + .15 * np.cos(2 * np.pi * b)) * np.sin(2 * np.pi * a), .5 + .15 * np.sin(2 * np.pi * b)), 90, 30, True, True)
    upright = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    things = dict(
        box=box((-.25, -.2, 0), (.25, .2, 1.7)), cube=box((-.4, -.4, 0), (.4, .4, .8)), wardrobe=box((-.5, -.3, 0), (.5, .3, 2.0)), plank=box((-.3, -.03, 0), (.3, .03, 1.7)),
        ball=ellipsoid(.5, .5, .5, (0, 0, .5)), egg=ellipsoid(.25, .2, .85, (0, 0, .85)), cigar=ellipsoid(.12, .12, .85, (0, 0, .85)), disc=ellipsoid(.5, .5, .06, (0, 0, .6)),
        cylinder=tube((0, 0, .2), (0, 0, 1.5), .18), pole=tube((0, 0, .1), (0, 0, 1.8), .04), cone=tube((0, 0, .3), (0, 0, 1.5), .3, .05), bottle=merged([tube((0, 0, .2), (0, 0, 1.0), .2), tube((0, 0, 1.0), (0, 0, 1.6), .08)]),
        ring=moved(ring, (0, 0, 0)), ring_upright=moved(moved(ring, (0, 0, -.5)), (0, 0, .75), about_x(90)), dog=dog, dog_upright=moved(dog, (0, 0, .8), upright), chair=chair, table=table,
        fish=merged([ellipsoid(.18, .12, .75, (0, 0, .8)), ellipsoid(.25, .02, .12, (0, 0, .08)), ellipsoid(.03, .02, .2, (.2, 0, .9))]),
        snowman=merged([ellipsoid(.35, .35, .35, (0, 0, .35)), ellipsoid(.25, .25, .25, (0, 0, .9)), ellipsoid(.16, .16, .16, (0, 0, 1.3))]),
        tree=merged([tube((0, 0, .1), (0, 0, 1.0), .08), ellipsoid(.45, .45, .45, (0, 0, 1.4))]), cross=merged([box((-.1, -.1, 0), (.1, .1, 1.7)), box((-.7, -.1, 1.1), (.7, .1, 1.3))]),
        bust_stand=merged([tube((0, 0, .05), (0, 0, 1.0), .03), ellipsoid(.25, .25, .03, (0, 0, .03)), ellipsoid(.12, .12, .12, (0, 0, 1.1))]),
        two_persons=merged([moved(body, (-.45, 0, 0)), moved(body, (.45, .2, 0), about_z(40))]), two_back_to_back=merged([moved(body, (0, -.3, 0)), moved(body, (0, .3, 0), about_z(180))]),
        upside_down=moved(body, (0, 0, top), about_x(180)), lying=moved(body, (0, -.85, .15), about_x(90)), hand=None, head=None,
        noise=(lambda p: (p, ConvexHull(p).simplices))(rng.normal(size=(4000, 3)) * [.3, .25, .6] + [0, 0, .9]),
        blob=(lambda m: (m[0] + .12 * np.sin(9 * m[0][:, [1, 2, 0]] + 3), m[1]))(ellipsoid(.3, .25, .8, (0, 0, .85))))
    arm = np.abs(v[:, 0]).max()
    tip = v[np.abs(v[:, 0]).argmax()]
    things['hand'] = kept(body, np.linalg.norm(v - tip, axis=1) < .17)
    things['head'] = kept(body, v[:, 2] > .90 * top)
    for name, mesh in things.items():
        write(os.path.join(out, name + '.ply'), *mesh)
    z, x = v[:, 2] / top, v[:, 0]
    halves = dict(upper=z > .5, lower=z < .5, trunk=(z > .44) & (z < .87) & (np.abs(x) < .6 * arm), no_head=z < .87, no_feet=z > .10, no_legs=z > .46, no_crown=z < .955,
                  no_left_forearm=~((x > .55 * arm) & (z < .80)), no_arms=(np.abs(x) < .13) | (z < .45) | (z > .85), left_half=x > -.02)
    for name, keep in halves.items():
        write(os.path.join(out, 'half_' + name + '.ply'), *kept(body, keep))
    print(len(things), 'non-bodies,', len(halves), 'halves')


if __name__ == '__main__':
    sys.exit(main())
