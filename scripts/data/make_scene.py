#!/usr/bin/env python3
"""Write effects/data/ground.obj, crates.obj, yard.obj and stack.obj: what stands around fire and smoke.

  python3 scripts/data/make_scene.py effects/data
"""
import math
import sys


def box(center, size, turn):
    """Corners of a box that stands on `center`, turned about Z by `turn` degrees."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    corners = []
    for z in (0, size[2]):
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            dx, dy = x * size[0] / 2, y * size[1] / 2
            corners.append((center[0] + c * dx - s * dy, center[1] + s * dx + c * dy, center[2] + z))
    return corners


FACES = ((1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8))
CRATES = (  # position, size, turn (degrees), material
    ((2.35, 2.30, 0), (0.62, 0.62, 0.62), 22, "crate"),
    ((1.75, 1.95, 0), (0.42, 0.42, 0.42), -12, "crate"),
    ((2.38, 2.32, 0.62), (0.40, 0.40, 0.40), 48, "crate"),
    ((6.05, 2.55, 0), (0.50, 0.50, 0.50), 33, "crate"),
    ((5.45, 1.70, 0), (0.34, 0.34, 0.34), 10, "crate"),
)


def yard():
    """A freight yard at night: a wall with openings behind, containers, posts and barrels around 4, 4."""
    for i in range(7):  # the wall: piers, and beams above and below the openings
        yield (-5.0 + 3.0 * i, 10.5, 0), (0.7, 0.5, 4.2), 0, "wall"
    yield (4.0, 10.5, 4.2), (18.7, 0.6, 0.6), 0, "wall"
    yield (4.0, 10.5, 0), (18.7, 0.45, 0.7), 0, "wall"
    containers = ((-2.6, 5.2, 0, 68, "red"), (-2.3, 5.3, 1.5, 61, "blue"), (10.9, 6.2, 0, -64, "green"),
                  (10.2, 1.6, 0, 8, "blue"))
    for x, y, z, turn, material in containers:
        yield (x, y, z), (4.2, 1.5, 1.46), turn, material
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        for k in range(14):  # the ribs of their long sides
            for side in (-1, 1):
                dx, dy = -1.95 + 0.3 * k, side * 0.78
                yield (x + c * dx - s * dy, y + s * dx + c * dy, z + 0.08), (0.12, 0.08, 1.3), turn, material
    for x, y, height in ((0.6, 0.9, 1.1), (2.4, 0.1, 1.1), (5.6, -0.1, 1.1), (7.5, 0.8, 1.1)):
        yield (x, y, 0), (0.16, 0.16, height), 20 * x, "steel"
    for x, y, turn in ((7.9, 3.0, 15), (8.3, 3.5, 60), (0.2, 3.2, 30), (8.05, 4.1, 80)):
        yield (x, y, 0), (0.46, 0.46, 0.75), turn, "steel"
        yield (x, y, 0), (0.46, 0.46, 0.75), turn + 45, "steel"


SIDES = 32
STACK = (  # height and radius of each ring of the chimney, material below it
    (0.0, 0.62, None), (3.6, 0.52, "concrete"), (4.2, 0.50, "red"), (4.8, 0.48, "white"), (5.4, 0.47, "red"),
    (6.0, 0.46, "white"), (6.0, 0.34, "concrete"), (5.5, 0.33, "soot"), (5.5, 0.0, "soot"),
)


def stack():
    """A chimney of 6 m, open at the top."""
    for (z0, r0, _), (z1, r1, material) in zip(STACK, STACK[1:]):
        corners = []
        for z, r in ((z0, r0), (z1, r1)):
            for i in range(SIDES):
                a = 2 * math.pi * i / SIDES
                corners.append((r * math.cos(a), r * math.sin(a), z))
        faces = []
        for i in range(1, SIDES + 1):
            k = i % SIDES + 1
            faces.append((i, k, SIDES + k, SIDES + i) if r1 > 0 else (i, k, SIDES + 1))
        yield material, corners, faces


def write(path, name, materials, groups):
    with open(path + ".mtl", "w") as out:
        for key, color in materials.items():
            out.write("newmtl %s\nKd %g %g %g\n" % ((key,) + color))
    with open(path + ".obj", "w") as out:
        out.write("# Made by scripts/data/make_scene.py. Z up, metres.\nmtllib %s.mtl\n" % name)
        base = 0
        for material, corners, faces in groups:
            for v in corners:
                out.write("v %.4f %.4f %.4f\n" % v)
            out.write("usemtl %s\n" % material)
            for f in faces:
                out.write("f %s\n" % " ".join(str(base + i) for i in f))
            base += len(corners)


folder = sys.argv[1]
far = 400
write(folder + "/ground", "ground", {"ground": (0.16, 0.14, 0.12)},
      [("ground", [(-far, -far, 0), (far, -far, 0), (far, far, 0), (-far, far, 0)], [(1, 2, 3, 4)])])
write(folder + "/crates", "crates", {"crate": (0.22, 0.13, 0.06)},
      [(m, box(p, s, t), FACES) for p, s, t, m in CRATES])
write(folder + "/yard", "yard", {"wall": (0.30, 0.27, 0.24), "red": (0.35, 0.06, 0.03), "blue": (0.05, 0.12, 0.25),
                                 "green": (0.06, 0.18, 0.08), "steel": (0.20, 0.20, 0.21)},
      [(m, box(p, s, t), FACES) for p, s, t, m in yard()])
write(folder + "/stack", "stack", {"concrete": (0.38, 0.36, 0.33), "red": (0.42, 0.06, 0.04), "white": (0.62, 0.61, 0.58),
                                   "soot": (0.02, 0.02, 0.02)}, stack())
