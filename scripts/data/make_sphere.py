#!/usr/bin/env python3
"""Write effects/data/sphere.obj: a round ball of radius 1 m.

  python3 scripts/data/make_sphere.py effects/data

A cube whose faces are bent to the sphere by tangents, so that its triangles are nearly of one size
everywhere (an icosahedron's would be, too, but has no rows to unfold a texture by).
"""
import math
import sys

CELLS = 20  # along each edge of the cube
FACES = (((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, -1, 0)), ((0, 1, 0), (-1, 0, 0)), ((0, -1, 0), (1, 0, 0)),
         ((0, 0, 1), (1, 0, 0)), ((0, 0, -1), (-1, 0, 0)))  # outwards, and one way along


def point(out, along, i, j):
    """On the sphere, and the same for neighbours of other faces."""
    up = tuple(out[(a + 1) % 3] * along[(a + 2) % 3] - out[(a + 2) % 3] * along[(a + 1) % 3] for a in range(3))
    s, t = (math.tan(math.pi / 4 * (2 * k / CELLS - 1)) for k in (i, j))
    p = [o + s * a + t * u for o, a, u in zip(out, along, up)]
    length = math.sqrt(sum(c * c for c in p))
    return tuple(round(c / length, 4) + 0.0 for c in p)


def main():
    numbers, lines, faces = {}, [], []
    for out, along in FACES:
        for j in range(CELLS):
            for i in range(CELLS):
                quad = [point(out, along, i + x, j + y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
                for p in quad:
                    if p not in numbers:
                        numbers[p] = len(numbers) + 1
                        lines.append("v %g %g %g" % p)
                faces.append("f %d %d %d %d" % tuple(numbers[p] for p in quad))
    with open(sys.argv[1] + "/sphere.obj", "w", encoding="ascii") as f:
        f.write("# A ball; made by scripts/data/make_sphere.py\n")
        f.write("\n".join(lines + ["usemtl ball"] + faces) + "\n")


if __name__ == "__main__":
    main()
