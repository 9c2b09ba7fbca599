#!/usr/bin/env python3
"""Write effects/data/ground.obj and effects/data/crates.obj: what stands around the explosion.

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
