#!/usr/bin/env python3
"""Write shard.obj, scrap.obj, lid.obj and scorch.obj: what is left of a barrel that has blown up.

  python3 scripts/data/make_blast.py effects/data
"""
import math
import random
import sys

dice = random.Random(5)


def shard():
    """A torn piece of a drum's wall, curved as the drum is, about its own middle."""
    radius, columns, rows = 0.29, 4, 3
    outside, inside = [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            edge = i in (0, columns) or j in (0, rows)
            tear = dice.uniform(-0.035, 0.05) if edge else 0
            angle = math.radians(-38 + 76 * i / columns) + tear * 2
            z = -0.17 + 0.34 * j / rows + tear
            bend = dice.uniform(-0.03, 0.03)
            for ring, r in ((outside, radius + bend), (inside, radius + bend - 0.012)):
                ring.append((r * math.cos(angle) - radius, r * math.sin(angle), z))
    faces = {"paint": [], "bare": []}
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            back = len(outside)
            faces["paint"] += [(a, b, c), (a, c, d)]
            faces["bare"] += [(back + a, back + c, back + b), (back + a, back + d, back + c)]
    return outside + inside, faces


def sheet(rows, columns, place, thickness):
    """Two grids of corners, outside and inside, and a rim between them."""
    corners, faces = [], {"paint": [], "bare": []}
    for depth in (0, thickness):
        corners += [place(i / columns, j / rows, depth) for j in range(rows + 1) for i in range(columns + 1)]
    back = len(corners) // 2

    def at(i, j):
        return j * (columns + 1) + i + 1

    for j in range(rows):
        for i in range(columns):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            faces["paint"] += [(a, b, c), (a, c, d)]
            faces["bare"] += [(back + a, back + c, back + b), (back + a, back + d, back + c)]
    rim = [at(i, 0) for i in range(columns)] + [at(columns, j) for j in range(rows)]
    rim += [at(i, rows) for i in range(columns, 0, -1)] + [at(0, j) for j in range(rows, 0, -1)]
    for a, b in zip(rim, rim[1:] + rim[:1]):
        faces["bare"] += [(a, back + a, back + b), (a, back + b, b)]
    return corners, faces


def scrap():
    """A strip of a drum's wall with its hoop: half unrolled, twisted, torn at its edges and folded at one."""
    torn = [[dice.uniform(-0.06, 0.03) for _ in range(40)] for _ in range(2)]
    heights = (-0.2, -0.06, -0.03, 0.0, 0.03, 0.06, 0.2)

    def place(u, v, depth):
        along, height = 2.3 * (u - 0.5), heights[round(6 * v)]
        if u in (0, 1):
            along += 2.2 * torn[0][round(6 * v) + 10 * round(u)]
        if v in (0, 1):
            height += torn[1][round(6 * u) + 10 * round(v)]
        hoop = 0.022 if v == 0.5 else 0.0
        radius = 0.2 + 0.1 * u + hoop - depth           # a roll that opens
        radius += 0.9 * max(0.0, -height - 0.04) ** 1.3  # folded outwards
        angle = along + 1.1 * height                     # and twisted
        return (radius * math.cos(angle) - 0.2, radius * math.sin(angle), height)

    return sheet(6, 6, place, 0.012)


def lid():
    """A drum's lid with its rim, bulged by the blast and bent across the middle."""

    def place(u, v, depth):
        far, rise = ((0.0, 0.05), (0.15, 0.035), (0.26, 0.0), (0.285, 0.03))[round(3 * v)]
        x, y = far * math.cos(2 * math.pi * u), far * math.sin(2 * math.pi * u)
        return (x, y, rise - depth + 1.6 * max(0.0, x + 0.4 * y) ** 2)

    return sheet(3, 14, place, 0.012)


def scorch():
    """A mark on the ground, darker towards its middle, with streaks where it was blown away."""
    corners, faces, count = [], {}, 40
    layers = (("singed", 1.0, 0.32, 0.001), ("soot", 0.74, 0.28, 0.002), ("char", 0.46, 0.25, 0.003))
    for name, reach, ragged, height in layers:
        first = len(corners) + 1
        corners.append((0.0, 0.0, height))
        for k in range(count):
            angle = 2 * math.pi * (k + dice.uniform(-0.3, 0.3)) / count
            far = reach * (1 - ragged * dice.random() ** (0.5 if k % 2 else 2))
            corners.append((far * math.cos(angle), far * math.sin(angle), height))
        faces[name] = [(first, first + 1 + k, first + 1 + (k + 1) % count) for k in range(count)]
    return corners, faces


def write(path, name, materials, shape):
    corners, faces = shape
    with open("%s/%s.mtl" % (path, name), "w") as out:
        for key, color in materials.items():
            out.write("newmtl %s\nKd %g %g %g\n" % ((key,) + color))
    with open("%s/%s.obj" % (path, name), "w") as out:
        out.write("# Made by scripts/data/make_blast.py. Z up, metres.\nmtllib %s.mtl\n" % name)
        for v in corners:
            out.write("v %.4f %.4f %.4f\n" % v)
        for key, list_of_faces in faces.items():
            out.write("usemtl %s\n" % key)
            for f in list_of_faces:
                out.write("f %d %d %d\n" % f)


folder = sys.argv[1]
steel = {"paint": (0.30, 0.032, 0.016), "bare": (0.10, 0.085, 0.08)}
write(folder, "shard", steel, shard())
write(folder, "scorch", {"singed": (0.062, 0.052, 0.044), "soot": (0.026, 0.022, 0.020), "char": (0.008, 0.007, 0.007)}, scorch())
write(folder, "scrap", steel, scrap())
write(folder, "lid", steel, lid())
