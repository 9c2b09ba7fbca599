#!/usr/bin/env python3
"""Write effects/data/valley.obj: a slope with a river at its foot, for a forest to stand on.

  python3 scripts/data/make_valley.py effects/data

`forest_fire.lua` says the same height as a field, so that trees stand on the ground: what is changed here is
changed there.
"""
import math
import sys

COLUMNS = [-132 + 3.3 * i for i in range(81)]  # x
# Distance from the middle of the river, rows close together where the banks are.
ROWS = [-62, -50, -40, -32, -26, -21, -17, -14, -11.5, -9.5, -8, -6.8, -5.8, -5, -4.2, -3.2, -1.6, 0, 1.6, 3.2, 4.2,
        5, 5.8, 6.8, 8, 9.5, 11.5, 14, 17, 20] + [20 + 3.6 * i for i in range(1, 36)]
COLORS = {
    "bed": (0.060, 0.056, 0.046), "gravel": (0.21, 0.19, 0.16), "bank": (0.15, 0.13, 0.075),
    "meadow": (0.105, 0.130, 0.040), "meadow_dark": (0.062, 0.090, 0.030), "meadow_dry": (0.185, 0.160, 0.062),
    "floor": (0.070, 0.062, 0.034),
}


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0), 1)
    return t * t * (3 - 2 * t)


def river(x):
    """y of its middle."""
    return -20 + 9 * math.sin(x / 26 + 0.7) + 3 * math.sin(x / 11)


def height(x, y):
    d = y - river(x)
    swells = 1.1 * math.sin(x / 13 + 1.3) * math.cos(y / 17) + 0.5 * math.sin(x / 5.3 + y / 7.1)
    bed = -1.9 * math.exp(-(d / 5.2) ** 2)
    slope = 24 * smoothstep(6, 100, d) + 2.5 * smoothstep(6, 40, -d)
    return bed + slope + swells * smoothstep(4, 15, abs(d))


def normal(x, y):
    e = 0.4
    n = (height(x - e, y) - height(x + e, y), height(x, y - e) - height(x, y + e), 2 * e)
    length = math.sqrt(sum(c * c for c in n))
    return tuple(c / length for c in n)


def material(x, d):
    """Patches with edges, as a painter would set them."""
    patch = math.sin(x / 7.3 + 2 * math.sin(d / 9.1)) + math.sin(d / 6.7 + 1.7 * math.sin(x / 12.7 + 1))
    if abs(d) < 4.2:
        return "bed"
    if abs(d) < 5.8:
        return "gravel"
    if abs(d) < 8:
        return "bank" if patch > -0.6 else "gravel"
    if d > 12 and patch < -0.75:
        return "floor"
    return "meadow_dry" if patch > 1.1 else "meadow" if patch > -0.1 else "meadow_dark"


def write(folder):
    faces = {name: [] for name in COLORS}
    lines = ["# Made by scripts/data/make_valley.py. Z up, metres.", "mtllib valley.mtl"]
    normals = []
    for d in ROWS:
        for x in COLUMNS:
            y = river(x) + d
            lines.append("v %.2f %.2f %.3f" % (x, y, height(x, y)))
            normals.append("vn %.3f %.3f %.3f" % normal(x, y))
    for j, (low, high) in enumerate(zip(ROWS, ROWS[1:])):
        for i, (left, right) in enumerate(zip(COLUMNS, COLUMNS[1:])):
            a = j * len(COLUMNS) + i + 1
            b = a + len(COLUMNS)
            faces[material((left + right) / 2, (low + high) / 2)].append((a, a + 1, b + 1, b))
    lines += normals
    for name, list_of in faces.items():
        lines.append("usemtl " + name)
        lines += ["f " + " ".join("%d//%d" % (c, c) for c in face) for face in list_of]
    with open(folder + "/valley.obj", "w", encoding="utf-8") as out:
        out.write("\n".join(lines) + "\n")
    with open(folder + "/valley.mtl", "w", encoding="utf-8") as out:
        out.write("# Made by scripts/data/make_valley.py.\n")
        for name, color in COLORS.items():
            out.write("newmtl %s\nKd %g %g %g\n" % (name, *color))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write(sys.argv[1])
