#!/usr/bin/env python3
"""Write effects/data/creature_hide.obj and creature_jaw_hide.obj: the dragon of make_creature.py as it
is to be seen, where creature.obj and creature_jaw.obj are what its breath meets. Its flesh is the same
distance; horns, teeth, scales and crest are triangles of their own, far finer than any cell of air.

  /usr/bin/python3 scripts/data/make_creature_hide.py effects/data

Debian: apt-get install python3-numpy. In the head's frame until the end, as there.
"""
import sys

sys.dont_write_bytecode = True
import numpy as np

import make_creature as creature
from scutes import Pile, ball, blade, onto, scales, scatter, sprinkle, tube, unit
from shapes import common, cut, join, limb, norm, spline
from surface import build, gradient, write_obj

SCRIPT = "make_creature_hide.py"
# Colour, how much is mirrored, and the exponent of the highlight: wet gums, polished horn, dull skin.
LOOKS = {
    "crease": ((0.050, 0.052, 0.042), 0.25, 12), "back": ((0.085, 0.104, 0.086), 0.85, 70),
    "dark": ((0.135, 0.160, 0.115), 0.70, 45), "green": ((0.205, 0.235, 0.150), 0.65, 32),
    "pale": ((0.320, 0.305, 0.200), 0.50, 24), "bronze": ((0.290, 0.180, 0.080), 0.90, 60),
    "belly": ((0.48, 0.41, 0.28), 0.45, 22), "belly_dark": ((0.36, 0.30, 0.20), 0.45, 22),
    "horn_root": ((0.150, 0.125, 0.098), 0.55, 40), "horn": ((0.300, 0.255, 0.190), 0.60, 50),
    "horn_tip": ((0.54, 0.48, 0.37), 0.70, 90), "groove": ((0.085, 0.070, 0.054), 0.30, 14),
    "tooth": ((0.66, 0.58, 0.44), 0.80, 110), "gum": ((0.17, 0.030, 0.028), 0.80, 90),
    "mouth": ((0.22, 0.035, 0.030), 0.75, 70), "iris": ((0.95, 0.46, 0.04), 1.0, 900),
    "rim": ((0.20, 0.055, 0.012), 1.0, 900), "pupil": ((0.004, 0.004, 0.004), 0.5, 300),
}
PATH = spline(creature.NECK, 12)
FIRST = 15       # of the points of PATH, where rows of scales begin
APART = 15.6     # degrees between the scales of a row
GROUND = -1.56   # how low on the neck anything is to be seen
EYE = (0.195, 0.160, 0.338)
TAILWARDS = np.array((-1.0, 0.0, 0.0))


class Flesh:
    """Distances that scales are laid onto."""

    def __init__(self):
        skin, lids, _, _, _ = creature.skull()
        self.hollow = creature.mouth()
        self.solid = join(0.10, skin, limb(*PATH), limb(*spline(creature.POUCH, 6)))
        self.whole = join(0.02, cut(0.03, self.solid, self.hollow), lids)


def sunk(mesh, shape, depth):
    """What scales lie on, a little lower: its few triangles would come through them where it is hollow."""
    vertices, faces, labels = mesh
    bare = np.array(labels) == "crease"
    covered = np.setdiff1d(faces[bare], faces[~bare])
    vertices = vertices.copy()
    vertices[covered] -= depth * unit(gradient(shape, vertices[covered], 0.01))
    return vertices, faces, labels


def flesh_mesh(flesh, cell, count):
    low, high = (-1.65, -0.62, -1.807), (1.42, 0.62, 0.62)
    hollow, solid = flesh.hollow, flesh.solid
    materials = {"crease": lambda p: np.full(len(p), 0.012),
                 "mouth": lambda p: np.where((np.abs(hollow(p)) < 0.02) & (solid(p) < -0.012), -0.01, 1.0),
                 "gum": lambda p: np.where((np.abs(hollow(p)) < 0.05) & (p[:, 2] < 0.07) & (p[:, 0] > 0.1), 0.0, 1.0)}
    mesh = build(common(0, flesh.whole, lambda p: -1.70 - p[:, 2]), low, high, cell, count, materials)
    return sunk(mesh, flesh.whole, 0.007)


def frame(k):
    """Of the neck at points k of its path: middle, towards the body, the front, radius."""
    i = np.arange(len(PATH))
    p = np.column_stack([np.interp(k, i, PATH[:, c]) for c in range(4)])
    way = np.gradient(PATH[:, :3], axis=0)
    way = unit(np.column_stack([np.interp(k, i, way[:, c]) for c in range(3)]))
    return p[:, :3], way, np.column_stack((-way[:, 2], np.zeros(len(way)), way[:, 0])), p[:, 3]


def steps(share, first=FIRST):
    """Points of the path that are a share of its radius apart."""
    length = np.concatenate(((0.0,), np.cumsum(np.sqrt((np.diff(PATH[:, :3], axis=0) ** 2).sum(axis=1)))))
    at, out = np.interp(first, np.arange(len(PATH)), length), []
    while at < length[-1]:
        k = float(np.interp(at, length, np.arange(len(PATH))))
        if np.interp(k, np.arange(len(PATH)), PATH[:, 2]) < GROUND:
            break
        out.append(k)
        at += share * np.interp(k, np.arange(len(PATH)), PATH[:, 3])
    return np.array(out)


def tones(height, dice):
    """Darker towards the back (1), paler towards the belly (0), here and there one that is neither."""
    names = np.array(("pale", "green", "dark", "back"))
    step = np.clip(height * 3.4 - 0.2 + dice.normal(0, 0.55, len(height)), 0, 3).round().astype(int)
    return np.where(dice.random(len(height)) < 0.09, "bronze", names[step])


def neck_rows(dice):
    """Where scales stand in rows around the neck: points, back, width, length, how high on the neck."""
    rows, out = steps(0.225), []
    for n, k in enumerate(rows):
        angle = np.radians(APART * (np.arange(8) + (0.5 if n % 2 else 1.0)))
        angle += np.radians(1.2) * dice.normal(0, 1, len(angle))
        (middle,), (way,), (ahead,), (radius,) = frame(np.array((k,)))
        out_of = -np.cos(angle)[:, None] * ahead + np.sin(angle)[:, None] * np.array((0.0, 1.0, 0.0))
        size = radius * (1 + 0.06 * dice.normal(0, 1, len(angle))) * (1.08 - 0.1 * np.cos(2 * angle))
        along = way + 0.10 * dice.normal(0, 1, (len(angle), 3))
        out.append(np.column_stack((middle + 1.01 * radius * out_of, along, 0.275 * size, 0.35 * size,
                                    1 - np.degrees(angle) / 125)))
    return np.concatenate(out)


def lay_rows(pile, flesh, dice):
    r = neck_rows(dice)
    scales(pile, flesh.whole, r[:, :3], r[:, 3:6], r[:, 6], r[:, 7], 0.10 * r[:, 6] * (1.4 + r[:, 8]),
           0.16 * r[:, 6] * (0.6 + r[:, 8]), tones(r[:, 8], dice))
    return r[:, :3], r[:, 6]


def lay_along(pile, shape, path, count, widths, length, lift, label, back=TAILWARDS):
    """A row of plates along a curve (x, y, z); widths: at its ends."""
    path = np.asarray(path, float)
    far = np.concatenate(((0.0,), np.cumsum(np.sqrt((np.diff(path, axis=0) ** 2).sum(axis=1)))))
    t = far[-1] * (np.arange(count) + 0.5) / count
    at = np.column_stack([np.interp(t, far, path[:, c]) for c in range(3)])
    width = np.linspace(*widths, count)
    along = np.gradient(at, axis=0)
    along *= np.sign((along @ np.asarray(back))[:, None] + 1e-9)
    scales(pile, shape, at, unit(along), width, length * width, lift * width, 0.16 * width, [label] * count)
    return at, 0.75 * width


def plates(pile, flesh):
    """Rows of larger plates on one side of the head: brow, bridge of the nose, lip."""
    brow = spline(((0.45, 0.140, 0.33), (0.30, 0.215, 0.42), (0.12, 0.262, 0.47), (0.02, 0.275, 0.485)), 6)
    under = spline(((0.40, 0.19, 0.255), (0.22, 0.262, 0.235), (0.02, 0.295, 0.27), (-0.12, 0.30, 0.33)), 5)
    bridge = spline(((0.93, 0.045, 0.275), (0.62, 0.055, 0.315), (0.35, 0.085, 0.42), (0.10, 0.12, 0.49)), 5)
    lip = spline([(x, 0.93 * w + 0.02, a + 0.045) for x, w, a, _ in creature.UPPER[2:-1]], 5)
    return [lay_along(pile, flesh.whole, brow, 8, (0.066, 0.105), 1.7, 0.36, "back"),
            lay_along(pile, flesh.whole, under, 8, (0.045, 0.075), 1.5, 0.18, "dark"),
            lay_along(pile, flesh.whole, bridge, 13, (0.06, 0.085), 1.4, 0.16, "dark"),
            lay_along(pile, flesh.whole, lip, 19, (0.066, 0.05), 1.35, 0.12, "pale")]


def head_room(p):
    """How far apart scales are on the head: fine at the snout and around the eye."""
    eye = norm(p - np.array(EYE))
    return np.clip(np.minimum(0.056 - 0.016 * p[:, 0], 0.024 + 0.16 * np.maximum(eye - 0.06, 0)), 0.024, 0.066)


def lay_head(pile, flesh, mesh, taken, dice):
    """Scales wherever skin of the head is left over, on one side."""
    p = sprinkle(mesh, 60000, dice)
    along, front = creature.on_neck(p)
    room = head_room(p)
    horned = np.min([limb(*spline(joints, 6))(p) for joints, _, _ in creature.HORNS], axis=0)
    free = ((p[:, 1] > 0.35 * room) & (p[:, 0] > -0.75) & (along < FIRST + 1) & (flesh.hollow(p) > 0.05) & (horned > 0.01)
            & (norm((p - np.array(EYE)) / (0.125, 0.2, 0.080)) > 1) & (norm(p - np.array((1.125, 0.125, 0.225))) > 0.05)
            & (norm(p - np.array((-0.27, 0.315, 0.535))) > 0.13) & ((front < 0.5) | (along < 13)))
    p, room = p[free], room[free]
    chosen = scatter(p, room, taken, dice)
    p, room = p[chosen], room[chosen]
    _, way, _, _ = frame(np.clip(creature.on_neck(p)[0], 0, len(PATH) - 1))
    share = np.clip((-0.1 - p[:, 0]) / 0.4, 0, 1)[:, None]
    back = unit(share * way + (1 - share) * TAILWARDS) + 0.12 * dice.normal(0, 1, p.shape)
    height = np.clip((p[:, 2] + 0.16) / 0.5, 0, 1)
    scales(pile, flesh.whole, p, back, 1.38 * room, 1.85 * room, 0.17 * room, 0.18 * room, tones(height, dice))


def crest(pile, flesh):
    """Blades from between the horns down the neck."""
    rows = steps(0.38, 2)
    middle, way, ahead, radius = frame(rows)
    at, _ = onto(flesh.whole, middle - 1.02 * radius[:, None] * ahead)
    for n, (p, back, out, r) in enumerate(zip(at, way, -ahead, radius)):
        high = r * (0.58 if n % 2 == 0 else 0.40) * min(1, 0.55 + 0.12 * n)
        blade(pile, p, out, back, high, 0.30 * r, 0.062 * r, ["horn_root"] * 2 + ["horn"] * 2 + ["horn_tip"] * 2)
    for joints, _ in creature.THORNS:
        (x, _, z, _), (_, _, top, _) = joints
        blade(pile, (x, 0, z), np.array((0.0, 0, 1)), TAILWARDS, 1.25 * (top - z), 0.05, 0.016, ["horn_root"] * 3 + ["horn"] * 3, 0.7)


def bands(pile, flesh):
    """Broad plates across the front of the neck, which overlap towards the body."""
    across = np.radians(np.linspace(-66, 66, 11))
    profile = np.array(((-0.62, -0.15), (0.0, 0.30), (0.42, 1.0), (0.50, 0.85), (0.50, -0.7)))
    edge = 1 - np.abs(np.linspace(-1, 1, 11)) ** 4
    for n, k in enumerate(steps(0.30, 15.5)):
        (middle,), (way,), (ahead,), (radius,) = frame(np.array((k,)))
        out_of = np.cos(across)[:, None] * ahead + np.sin(across)[:, None] * np.array((0.0, 1.0, 0.0))
        long = 0.42 * radius * (0.62 + 0.38 * edge)
        p = (middle + 1.01 * radius * out_of)[:, None, :] + (long[:, None] * profile[:, 0])[..., None] * way
        p, up = onto(flesh.whole, p.reshape(-1, 3), 0.012)
        height = (0.085 * radius * (edge[:, None] * (profile[:, 1] + 0.15) - 0.15)).reshape(-1, 1)
        i, j = np.meshgrid(np.arange(10), np.arange(4), indexing="ij")
        a = (i * 5 + j).ravel()
        faces = np.concatenate((np.column_stack((a, a + 1, a + 6)), np.column_stack((a, a + 6, a + 5))))
        pile.add(p + height * up, faces, "belly" if n % 3 else "belly_dark")


def horns(pile, which):
    """Rings that rise slowly and fall at once, as they grow; none near the tip."""
    ringed, bare, rise, swell = 0.80, 7, (0.0, 0.45, 0.86), (-0.6, 0.4, 1.0)
    for (joints, count, depth), sides in zip(which, (14, 10, 9)):
        edge = ringed * (np.arange(count + 1) / count) ** 0.9  # closer towards the tip
        t = np.append((edge[:-1, None] + np.diff(edge)[:, None] * rise).ravel(), np.linspace(ringed, 1, bare))
        wider = np.append(np.tile(swell, count), np.zeros(bare))
        dense = spline(joints, 60)
        j = np.column_stack([np.interp(t, np.linspace(0, 1, len(dense)), dense[:, c]) for c in range(4)])
        j[:, 3] = np.maximum(j[:, 3] * (1 + 1.1 * depth * np.clip(1.25 - 1.3 * t, 0, 1) * wider), 0.003)
        body = np.where(t < 0.22, "horn_root", np.where(t < 0.68, "horn", "horn_tip"))
        fall = (np.arange(len(t)) % len(swell) == len(swell) - 1) & (t < 0.72)
        tube(pile, j, sides, np.where(fall, "groove", body).tolist())


def teeth(pile, keys, rows, level, up):
    for t in creature.row(keys, rows, level):
        tube(pile, spline(creature.fang(*t, up), 3), 7, ["gum"] + ["tooth"] * 6)


def eye(pile):
    pole = (0.30, 0.95, 0.06)
    ball(pile, EYE, (0.072, 0.072, 0.068), pole, 9, 16, lambda a: "iris" if a < 42 else "rim")
    pupil = np.array(EYE) + 0.046 * unit(np.array(pole))
    ball(pile, pupil, (0.013, 0.028, 0.050), pole, 6, 10, lambda a: "pupil")


def upper(cell):
    """The parts of one side, mirrored, and what stands in the middle."""
    dice, flesh, side, whole = np.random.default_rng(7), Flesh(), Pile(), Pile()
    mesh = flesh_mesh(flesh, cell, 6500)
    taken = [lay_rows(side, flesh, dice)] + plates(side, flesh)
    crease = [i for i, label in enumerate(mesh[2]) if label == "crease"]
    lay_head(side, flesh, (mesh[0], mesh[1][crease]), [np.concatenate(x) for x in zip(*taken)], dice)
    teeth(side, creature.UPPER, creature.TEETH_ABOVE, 2, -1)
    eye(side)
    horns(side, creature.HORNS[:3])
    side.mirror()
    horns(side, creature.HORNS[3:])
    for part in (mesh, side.mesh()):
        whole.add(*part)
    crest(whole, flesh)
    bands(whole, flesh)
    return whole.mesh()


def lower(cell):
    """The same of the jaw, closed."""
    dice, side, whole = np.random.default_rng(8), Pile(), Pile()
    solid, trough, tongue = creature.chin()
    bone = cut(0.025, solid, trough)
    shape = join(0.012, bone, tongue)
    materials = {"crease": lambda p: np.full(len(p), 0.012),
                 "mouth": lambda p: np.where(((np.abs(trough(p)) < 0.02) & (solid(p) < -0.008)) | (tongue(p) < 0.008), -0.01, 1.0),
                 "gum": lambda p: np.where((trough(p) < 0.035) & (p[:, 0] > 0.1), 0.0, 1.0)}
    mesh = sunk(build(shape, (-0.35, -0.40, -0.45), (1.40, 0.40, 0.25), cell, 2000, materials), shape, 0.004)
    lip = spline([(x, 0.92 * w + 0.02, b - 0.045) for x, w, _, b in creature.LOWER[2:-1]], 5)
    taken = lay_along(side, bone, lip, 18, (0.062, 0.048), 1.4, 0.12, "green")
    p = sprinkle((mesh[0], mesh[1][[i for i, label in enumerate(mesh[2]) if label == "crease"]]), 30000, dice)
    room = np.clip(0.056 - 0.014 * p[:, 0], 0.034, 0.06)
    p, room = (x[(p[:, 1] > 0.3 * room) & (trough(p) > 0.045)] for x in (p, room))
    chosen = scatter(p, room, taken, dice)
    p, room = p[chosen], room[chosen]
    scales(side, bone, p, TAILWARDS + 0.12 * dice.normal(0, 1, p.shape), 1.38 * room, 1.85 * room, 0.17 * room, 0.16 * room,
           tones(np.clip((p[:, 2] + 0.24) / 0.4, 0, 1), dice))
    teeth(side, creature.LOWER, creature.TEETH_BELOW, 3, 1)
    for joints, _, _ in creature.SPURS[:2]:
        tube(side, spline(joints, 5), 9, ["horn_root"] * 3 + ["horn"] * 3)
    side.mirror()
    tube(side, spline(creature.SPURS[2][0], 5), 9, ["horn_root"] * 3 + ["horn"] * 3)
    for part in (mesh, side.mesh()):
        whole.add(*part)
    return whole.mesh()


def main(folder, cell):
    write_obj(folder, "creature_hide", SCRIPT, creature.in_world(upper(cell), creature.HEAD), LOOKS)
    vertices, faces, labels = lower(cell)
    mesh = creature.in_world((vertices - creature.HINGE, faces, labels), (0, 0, 0))
    write_obj(folder, "creature_jaw_hide", SCRIPT, mesh, {k: v for k, v in LOOKS.items() if k in set(labels)})


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.013)
