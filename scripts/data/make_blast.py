#!/usr/bin/env python3
"""Write effects/data/shard.obj and scorch.obj: what is left of a barrel that has blown up.

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


def scorch():
    """A mark on the ground, darker towards its middle, with streaks where it was blown away."""
    corners, faces, count = [], {}, 40
    layers = (("singed", 1.0, 0.32, 0.003), ("soot", 0.74, 0.28, 0.006), ("char", 0.46, 0.25, 0.009))
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
write(folder, "shard", {"paint": (0.30, 0.032, 0.016), "bare": (0.10, 0.085, 0.08)}, shard())
write(folder, "scorch", {"singed": (0.062, 0.052, 0.044), "soot": (0.026, 0.022, 0.020), "char": (0.008, 0.007, 0.007)}, scorch())
