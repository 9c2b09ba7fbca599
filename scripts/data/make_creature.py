#!/usr/bin/env python3
"""Write effects/data/creature.obj, creature_jaw.obj and creature_throat.obj: a dragon's neck and head
with an open gullet, its lower jaw, which turns about its own origin, and what its breath begins in.

  /usr/bin/python3 scripts/data/make_creature.py effects/data

Debian: apt-get install python3-numpy. The head is drawn with its mouth's corner at the origin, and
looks along +X; then it is put where it belongs.
"""
import sys

import numpy as np

from shapes import common, cut, ellipsoid, join, limb, loft, mirrored, near, spline, turned
from surface import build, write_obj

HEAD, TILT = (0.0, 0.0, 1.70), turned(-7, "y")  # where the corner of the mouth lies, and how far it looks up
HINGE = (-0.12, 0.0, -0.03)                     # of the jaw, in the head's frame
COLORS = {"skin": (0.150, 0.175, 0.130), "belly": (0.34, 0.29, 0.20), "horn": (0.33, 0.28, 0.21), "mouth": (0.22, 0.035, 0.03),
          "eye": (0.9, 0.42, 0.03)}

UPPER = ((-0.42, 0.17, 0.06, 0.36), (-0.25, 0.25, 0.02, 0.43), (0.0, 0.265, 0.0, 0.46), (0.25, 0.225, 0.0, 0.42),
         (0.50, 0.175, 0.01, 0.31), (0.80, 0.150, 0.015, 0.245), (1.02, 0.155, 0.0, 0.255), (1.18, 0.115, -0.02, 0.205),
         (1.27, 0.045, -0.03, 0.11))
LOWER = ((-0.27, 0.17, -0.235, -0.12), (-0.12, 0.20, -0.235, 0.02), (0.05, 0.215, -0.23, 0.02), (0.25, 0.20, -0.21, -0.02), (0.60, 0.145, -0.155, -0.025),
         (0.95, 0.125, -0.135, -0.02), (1.15, 0.10, -0.125, -0.005), (1.24, 0.04, -0.08, -0.005))


def shrunk(keys, side, low, high):
    return tuple((x, max(w - side, 0.01), a + low, b + high) for x, w, a, b in keys)


def fang(x, y, z, length, thick, up):
    return ((x, y, z - up * 0.03, thick), (x + 0.012, y * 1.03, z + up * 0.45 * length, 0.72 * thick),
            (x - 0.14 * length, y, z + up * length, 0.003))


def tooth(x, y, z, length, thick, up):
    """A fang that curves backwards; up: 1 or -1."""
    joints = fang(x, y, z, length, thick, up)
    return near(limb(*joints), joints[1][:3], length)


TEETH_ABOVE = tuple(zip((1.225, 1.13, 1.03, 0.93, 0.83, 0.73, 0.63, 0.53, 0.43, 0.34, 0.25),
                        (0.09, 0.19, 0.10, 0.08, 0.12, 0.13, 0.10, 0.085, 0.075, 0.06, 0.05)))
TEETH_BELOW = tuple(zip((1.19, 1.08, 0.98, 0.88, 0.78, 0.68, 0.58, 0.48, 0.39, 0.30),
                        (0.08, 0.155, 0.09, 0.075, 0.10, 0.11, 0.09, 0.075, 0.065, 0.05)))


def row(keys, teeth, level):
    """Teeth (x, length) along the edge of a jaw: (x, y, z, length, thickness) of each."""
    keys = np.array(keys)
    for x, length in teeth:
        y, z = (np.interp(x, keys[:, 0], keys[:, k]) for k in (1, level))
        yield x, 0.86 * y, z, length, 0.012 + 0.11 * length


def horn(joints, rings, depth):
    """A horn with rings, which end before its tip."""
    j = spline(joints, 14)
    t = np.arange(len(j)) / (len(j) - 1)
    j[:, 3] *= 1 + depth * np.clip(1.4 - 1.8 * t, 0, 1) * np.cos(2 * np.pi * rings * t)
    j[:, 3] = np.maximum(j[:, 3], 0.004)
    middle = (j[0, :3] + j[-1, :3]) / 2
    return near(limb(*j), middle, 0.12 + 0.5 * np.sqrt(((j[0, :3] - j[-1, :3]) ** 2).sum()))


def spikes(path, count, height, thick):
    """Along a curve (x, y, z, -): spikes that lean back, in the plane y = 0."""
    j = spline(path, 20)
    out = []
    for t in (np.arange(count) + 0.5) / count:
        at = t * (len(j) - 1)
        i = int(at)
        p, along = j[i, :3], j[min(i + 1, len(j) - 1), :3] - j[i, :3]
        along = along / np.sqrt(along @ along)
        out_of = np.array((along[2], 0, -along[0]))
        h = height * (0.55 + 0.45 * np.sin(np.pi * min(1, 0.25 + t)))
        tip = p + (j[i, 3] + h) * out_of + 0.75 * h * along
        root = p + 0.92 * j[i, 3] * out_of
        out.append(near(limb((*root, thick), (*(0.6 * root + 0.4 * tip), 0.62 * thick), (*tip, 0.004)), (root + tip) / 2, h + thick))
    return out


NECK = ((-0.20, 0, 0.20, 0.24), (-0.52, 0, 0.10, 0.255), (-0.86, 0, -0.18, 0.265), (-1.06, 0, -0.62, 0.295), (-1.02, 0, -1.12, 0.35),
        (-0.86, 0, -1.62, 0.43), (-0.82, 0, -1.95, 0.47))
GULLET = ((0.55, 0, -0.01, 0.08), (0.20, 0, 0.01, 0.13), (-0.10, 0, 0.04, 0.15), (-0.42, 0, 0.08, 0.145), (-0.68, 0, 0.01, 0.13),
          (-0.84, 0, -0.24, 0.10))
POUCH = ((-0.50, 0, 0.03, 0.20), (-0.30, 0, -0.03, 0.19), (-0.12, 0, -0.07, 0.15))  # below the gullet: the jaw turns around it


def on_neck(p):
    """How far along the neck each point lies, in twelfths of a joint, and how far in front, in radii."""
    j = spline(NECK, 12)
    k = np.clip(np.argmin(((p[:, None, :] - j[None, :, :3]) ** 2).sum(axis=2), axis=1), 1, len(j) - 2)
    way = j[k + 1, :3] - j[k - 1, :3]
    way /= np.sqrt((way * way).sum(axis=1))[:, None]
    ahead = np.column_stack((-way[:, 2], np.zeros(len(p)), way[:, 0]))
    off = p - j[k, :3]
    return k + (off * way).sum(axis=1) / 0.045, (off * ahead).sum(axis=1) / j[k, 3]


def neck():
    """A neck with plates on its front."""
    tube = limb(*spline(NECK, 12))

    def distance(p):
        d = tube(p)
        close = np.abs(d) < 0.1
        along, front = on_neck(p[close])
        plates = np.clip((front - 0.45) * 4, 0, 1)
        d[close] += 0.018 * plates * ((along / 2.2) % 1.0) - 0.02 * plates
        return d
    return distance


# Joints (x, y, z, radius), how many rings, how deep these are.
HORNS = (
    (((-0.10, 0.150, 0.42, 0.085), (-0.34, 0.225, 0.58, 0.088), (-0.66, 0.32, 0.68, 0.068), (-0.98, 0.40, 0.66, 0.046),
      (-1.26, 0.42, 0.72, 0.024), (-1.42, 0.40, 0.84, 0.004)), 17, 0.09),
    (((-0.26, 0.22, 0.30, 0.062), (-0.48, 0.34, 0.36, 0.054), (-0.72, 0.44, 0.34, 0.034), (-0.90, 0.48, 0.38, 0.004)), 9, 0.08),
    (((-0.24, 0.23, 0.14, 0.052), (-0.42, 0.35, 0.11, 0.042), (-0.60, 0.43, 0.04, 0.024), (-0.72, 0.45, 0.02, 0.004)), 6, 0.08),
    (((0.98, 0.0, 0.22, 0.052), (1.0, 0.0, 0.30, 0.040), (0.97, 0.0, 0.40, 0.004)), 3, 0.06),
)
THORNS = ((((0.72, 0, 0.26, 0.035), (0.67, 0, 0.335, 0.004)), (0.7, 0, 0.3)),
          (((0.52, 0, 0.32, 0.035), (0.46, 0, 0.405, 0.004)), (0.5, 0, 0.36)))
# Of the jaw; and a ball around each.
SPURS = ((((0.30, 0.15, -0.17, 0.04), (0.16, 0.20, -0.29, 0.004)), (0.23, 0.17, -0.23), 0.12),
         (((0.02, 0.19, -0.16, 0.045), (-0.16, 0.26, -0.27, 0.004)), (-0.07, 0.22, -0.21), 0.15),
         (((1.12, 0, -0.10, 0.045), (1.06, 0, -0.22, 0.004)), (1.1, 0, -0.16), 0.1))


def skull():
    """The upper half: what has skin, what has horn, eyes, and what is cut out."""
    face = join(
        0.07, loft(UPPER, 2.6), ellipsoid((-0.14, 0.06, 0.26), (0.30, 0.22, 0.21)),
        ellipsoid((-0.08, 0.20, 0.13), (0.20, 0.095, 0.15)),                                     # cheek
        ellipsoid((-0.17, 0.17, -0.05), (0.16, 0.085, 0.17)),                                    # and where the jaw is held
        ellipsoid((1.07, 0.085, 0.215), (0.085, 0.055, 0.055)),                                  # nostril
        limb((0.62, 0.03, 0.285, 0.035), (0.35, 0.06, 0.385, 0.045), (0.10, 0.09, 0.455, 0.05)), # bridge of the nose
    )
    brow = limb(*spline(((0.44, 0.135, 0.315, 0.022), (0.30, 0.195, 0.395, 0.042), (0.12, 0.235, 0.445, 0.052), (-0.08, 0.265, 0.475, 0.045),
                         (-0.27, 0.315, 0.535, 0.010)), 6))
    under = limb(*spline(((0.38, 0.175, 0.255, 0.018), (0.22, 0.235, 0.235, 0.030), (0.02, 0.265, 0.27, 0.032), (-0.12, 0.28, 0.33, 0.016)), 5))
    lip = limb(*spline([(x, 0.93 * w, a + 0.035, 0.026) for x, w, a, _ in UPPER[1:-1]], 4))
    skin = join(0.035, face, brow, under, lip)
    skin = cut(0.03, skin, ellipsoid((0.205, 0.235, 0.338), (0.105, 0.055, 0.058), turned(12, "z")))
    skin = cut(0.015, skin, ellipsoid((1.125, 0.125, 0.225), (0.034, 0.030, 0.020), turned(-30, "z")))
    lids = near(join(0.0, limb(*spline(((0.30, 0.180, 0.335, 0.016), (0.20, 0.222, 0.392, 0.022), (0.09, 0.232, 0.37, 0.016)), 5)),
                     limb(*spline(((0.30, 0.185, 0.33, 0.014), (0.20, 0.230, 0.288, 0.018), (0.09, 0.235, 0.33, 0.014)), 5))),
                (0.2, 0.2, 0.34), 0.16)
    eye = near(ellipsoid((0.195, 0.160, 0.338), (0.072, 0.072, 0.068)), (0.195, 0.16, 0.338), 0.08)
    horns = join(
        0.0,
        *(horn(*h) for h in HORNS),
        *(near(limb(*joints), middle, 0.1) for joints, middle in THORNS),
    )
    teeth = join(0.0, *(tooth(*t, -1) for t in row(UPPER, TEETH_ABOVE, 2)))
    return mirrored(skin), mirrored(join(0.02, lids)), mirrored(eye), mirrored(horns), mirrored(teeth)


def mouth():
    """What of the upper half is empty."""
    palate = loft(shrunk(UPPER, 0.085, -0.2, -0.15), 2.2)
    palate = cut(0.03, palate, lambda p: p[:, 0] + 0.02, lambda p: 1.10 - p[:, 0])  # behind the jaw the gullet is whole
    return join(0.08, limb(*spline(GULLET, 6)), palate)


def upper():
    """Head and neck, and the shapes by which triangles get their material."""
    skin, lids, eye, horns, teeth = skull()
    throat = neck()
    spines = join(0.0, *spikes(NECK, 13, 0.17, 0.045))
    hollow, solid = mouth(), join(0.10, skin, throat, limb(*spline(POUCH, 6)))
    body = cut(0.03, solid, hollow)
    body = join(0.012, join(0.02, body, lids), eye)
    whole = join(0.012, join(0.03, body, horns), join(0.015, teeth), spines)
    whole = common(0, whole, lambda p: -1.70 - p[:, 2])
    horny = join(0, horns, teeth, spines)

    def belly(p):
        along, front = on_neck(p)
        return np.where((front > 0.52) & (np.abs(throat(p)) < 0.05) & (along > 8), -0.02, 1.0)
    materials = {"skin": lambda p: np.full(len(p), 0.012), "belly": belly, "horn": horny,
                 "mouth": lambda p: np.where((np.abs(hollow(p)) < 0.02) & (solid(p) < -0.012), -0.01, 1.0), "eye": lambda p: eye(p) - 0.002}
    return whole, materials


def chin():
    """The jaw without teeth, closed, in the head's frame: bone and skin, what is cut out, the tongue."""
    bone = join(0.06, loft(LOWER, 2.6), ellipsoid((-0.02, 0.185, -0.06), (0.17, 0.07, 0.15)))
    lip = limb(*spline([(x, 0.92 * w, b - 0.03, 0.022) for x, w, _, b in LOWER[1:-1]], 4))
    bone = join(0.03, bone, lip)
    trough = cut(0.02, loft(shrunk(LOWER, 0.065, 0.07, 0.2), 2.4), lambda p: 1.10 - p[:, 0])
    tongue = limb((-0.02, 0, -0.115, 0.06), (0.40, 0, -0.085, 0.062), (0.75, 0, -0.062, 0.052), (0.95, 0, -0.030, 0.034), (1.04, 0, 0.005, 0.008))
    return mirrored(bone), trough, lambda p: tongue(p * (1, 0.75, 1.0))


def jaw():
    """The lower jaw, closed, in the head's frame."""
    solid, trough, flat = chin()
    teeth = join(0.0, *(tooth(*t, 1) for t in row(LOWER, TEETH_BELOW, 3)))
    spurs = join(0.0, *(near(limb(*joints), middle, reach) for joints, middle, reach in SPURS))
    horny = join(0, mirrored(teeth), mirrored(spurs))
    whole = cut(0.025, solid, trough)
    whole = join(0.012, join(0.03, whole, flat), join(0.015, horny))
    materials = {"skin": lambda p: np.full(len(p), 0.012), "horn": horny,
                 "mouth": lambda p: np.where(((np.abs(trough(p)) < 0.02) & (solid(p) < -0.008)) | (flat(p) < 0.008), -0.01, 1.0)}
    return whole, materials


def breath():
    """What fills the back of the gullet, a little less wide."""
    return limb((-0.18, 0, 0.045, 0.12), (-0.42, 0, 0.08, 0.12), (-0.60, 0, 0.04, 0.10))


def in_world(mesh, at):
    vertices, faces, labels = mesh
    return vertices @ TILT.T + np.array(at), faces, labels


def main(folder, cell):
    hinge = np.array(HEAD) + TILT @ np.array(HINGE)
    whole, materials = upper()
    write_obj(folder, "creature", "make_creature.py",
              in_world(build(whole, (-1.65, -0.62, -1.9), (1.42, 0.62, 0.98), cell, 17000, materials), HEAD), COLORS)
    whole, materials = jaw()
    vertices, faces, labels = build(whole, (-0.35, -0.40, -0.45), (1.40, 0.40, 0.25), cell, 6000, materials)
    write_obj(folder, "creature_jaw", "make_creature.py", in_world((vertices - HINGE, faces, labels), (0, 0, 0)),
              {k: COLORS[k] for k in materials})
    write_obj(folder, "creature_throat", "make_creature.py",
              in_world(build(breath(), (-0.85, -0.2, -0.35), (0.05, 0.2, 0.25), 0.02, 400), HEAD), {"body": (0.5, 0.5, 0.5)})
    print("the jaw's hinge: %.3f %.3f %.3f" % tuple(hinge))


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.014)
