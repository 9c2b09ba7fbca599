#!/usr/bin/env python3
"""Write effects/data/logs.obj and cigarette.obj: what burns.

  python3 scripts/data/make_fire.py effects/data
"""
import math
import random
import sys

SIDES = 14


def normal(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rod(start, end, radius, parts, rough, dice):
    """Groups of a round rod. `parts`: materials and where each ends, 0 to 1; the caps have the first and last."""
    along = normal(tuple(e - s for s, e in zip(start, end)))
    side = normal(cross(along, (0, 0, 1) if abs(along[2]) < 0.9 else (1, 0, 0)))
    up = cross(side, along)
    bark = [1 + rough * dice.uniform(-1, 1) for _ in range(SIDES)]
    rings, at, materials = [], 0, []
    for material, until in parts:
        count = max(1, round((until - at) * (8 if rough else 1)))
        materials += [material] * count
        rings += [at + (until - at) * k / count for k in range(count)]
        at = until
    rings.append(1)
    corners = []
    for t in rings:
        bend = [rough * radius * dice.uniform(-1, 1) for _ in range(2)] if rough else (0, 0)
        for i in range(SIDES):
            a = 2 * math.pi * i / SIDES
            r = radius * bark[i] * (1 + 0.5 * rough * dice.uniform(-1, 1))
            x, y = r * math.cos(a) + bend[0], r * math.sin(a) + bend[1]
            corners.append(tuple(s + (e - s) * t + x * p + y * q for s, e, p, q in zip(start, end, side, up)))
    for k, material in enumerate(materials):
        ring = corners[k * SIDES:(k + 2) * SIDES]
        yield material, ring, [(i + 1, (i + 1) % SIDES + 1, SIDES + (i + 1) % SIDES + 1, SIDES + i + 1) for i in range(SIDES)]
    yield "cut" if rough else parts[0][0], corners[:SIDES], [tuple(range(SIDES, 0, -1))]
    yield "coal" if rough else parts[-1][0], corners[-SIDES:], [tuple(range(1, SIDES + 1))]


def stone(center, size, dice):
    """A pebble: a ball of rings, dented."""
    rings, corners = 5, [(center[0], center[1], center[2] + size[2])]
    for k in range(1, rings):
        b = math.pi * k / rings
        for i in range(8):
            a = 2 * math.pi * (i + 0.5 * k) / 8
            dent = dice.uniform(0.82, 1.1)
            corners.append((center[0] + dent * size[0] * math.sin(b) * math.cos(a),
                            center[1] + dent * size[1] * math.sin(b) * math.sin(a), center[2] + dent * size[2] * math.cos(b)))
    corners.append((center[0], center[1], center[2] - size[2]))
    faces = [(1, 2 + i, 2 + (i + 1) % 8) for i in range(8)]
    for k in range(rings - 2):
        for i in range(8):
            a, b = 2 + 8 * k + i, 2 + 8 * k + (i + 1) % 8
            faces += [(a, a + 8, b + 8), (a, b + 8, b)]
    last = len(corners)
    faces += [(last, last - 8 + (i + 1) % 8, last - 8 + i) for i in range(8)]
    return "stone", corners, faces


def logs():
    """Logs that lean against each other in a ring of stones, charred where they meet."""
    dice = random.Random(4)
    for i in range(7):
        a = 2 * math.pi * (i + 0.25 * dice.uniform(-1, 1)) / 7
        c, s = math.cos(a), math.sin(a)
        foot, top, lean = 0.42 + 0.06 * dice.uniform(-1, 1), 0.30 + 0.08 * dice.uniform(-1, 1), dice.uniform(-0.05, 0.05)
        yield from rod((foot * c, foot * s, 0.05), (-0.06 * c - lean * s, -0.06 * s + lean * c, top), dice.uniform(0.045, 0.065),
                       (("bark", 0.45), ("coal", 1)), 0.09, dice)
    for i in range(15):
        a = 2 * math.pi * (i + 0.2 * dice.uniform(-1, 1)) / 15
        r = 0.68 + 0.04 * dice.uniform(-1, 1)
        size = tuple(dice.uniform(0.09, 0.14) for _ in range(2)) + (dice.uniform(0.06, 0.1),)
        yield stone((r * math.cos(a), r * math.sin(a), 0.6 * size[2]), size, dice)


DISH = ((0.0, -0.026), (0.047, -0.026), (0.053, -0.004), (0.057, -0.003), (0.061, -0.006), (0.058, -0.032), (0.0, -0.032))


def cigarette():
    """A cigarette whose glowing end is at the origin, on the rim of a dish."""
    at, parts = (-0.084, 0.0, 0.004), (("ash", 0.10), ("paper", 0.68), ("filter", 1))
    yield from rod((0, 0, 0), at, 0.004, parts, 0, random.Random(1))
    count = 48
    for (r0, z0), (r1, z1) in zip(DISH, DISH[1:]):
        corners = [(r * math.cos(2 * math.pi * i / count) + 0.012, r * math.sin(2 * math.pi * i / count), z)
                   for r, z in ((r0, z0), (r1, z1)) for i in range(count)]
        yield "dish", corners, [(i + 1, (i + 1) % count + 1, count + (i + 1) % count + 1, count + i + 1) for i in range(count)]


def write(folder, name, materials, groups):
    with open("%s/%s.mtl" % (folder, name), "w") as out:
        for key, color in materials.items():
            out.write("newmtl %s\nKd %g %g %g\n" % ((key,) + color))
    with open("%s/%s.obj" % (folder, name), "w") as out:
        out.write("# Made by scripts/data/make_fire.py. Z up, metres.\nmtllib %s.mtl\n" % name)
        base = 0
        for material, corners, faces in groups:
            for v in corners:
                out.write("v %.4f %.4f %.4f\n" % v)
            out.write("usemtl %s\n" % material)
            for f in faces:
                out.write("f %s\n" % " ".join(str(base + i) for i in f))
            base += len(corners)


write(sys.argv[1], "logs", {"bark": (0.16, 0.10, 0.06), "coal": (0.03, 0.026, 0.024), "cut": (0.42, 0.28, 0.15),
                            "stone": (0.24, 0.23, 0.22)}, logs())
write(sys.argv[1], "cigarette", {"ash": (0.35, 0.34, 0.33), "paper": (0.80, 0.79, 0.77), "filter": (0.62, 0.34, 0.14),
                                 "dish": (0.05, 0.055, 0.06)}, cigarette())
