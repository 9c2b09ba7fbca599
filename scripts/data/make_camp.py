#!/usr/bin/env python3
"""Write effects/data/barrel.obj: a drum of oil that has stood outside for long.

  /usr/bin/python3 scripts/data/make_camp.py effects/data
"""
import math
import sys

sys.dont_write_bytecode = True
from polygons import Mesh, add, around, mix, tube, unit

SCRIPT = "make_camp.py"


def turned(mesh, profile, sides, pick, angle=50, wobble=lambda i, k: 0.0):
    """A surface of revolution of (radius, z) from the foot up; pick(ring, side): the material of a face."""
    since, rings = mesh.mark(), []
    for i, (radius, z) in enumerate(profile):
        rings.append([around(360 * k / sides, radius + wobble(i, k), z) for k in range(sides)])
    for i in range(len(profile) - 1):
        low, high = rings[i], rings[i + 1]
        for k in range(sides):
            j = (k + 1) % sides
            if profile[i][0] == 0:
                mesh.face(pick(i, k), low[k], high[j], high[k])
            elif profile[i + 1][0] == 0:
                mesh.face(pick(i, k), low[k], low[j], high[k])
            else:
                mesh.face(pick(i, k), low[k], low[j], high[j], high[k])
    mesh.smooth(since, angle)


# ---- a drum of oil -----------------------------------------------------------------------------------

HOOPS = (0.275, 0.575)  # the rolled beads of a drum of 200 litres, 0.88 m high
BAND = (0.335, 0.515)   # between them: what it warns of


def barrel(seed=7):
    mesh, sides, r = Mesh(seed), 24, 0.29
    lower = [(0, 0.012), (0.265, 0.012), (0.270, 0.0), (0.292, 0.0), (0.298, 0.012), (0.296, 0.026), (r, 0.032)]
    beads = [(r + out, z + dz) for z in HOOPS for out, dz in ((0, -0.026), (0.017, -0.010), (0.017, 0.010), (0, 0.026))]
    upper = [(r, 0.848), (0.296, 0.854), (0.298, 0.868), (0.292, 0.880), (0.274, 0.880), (0.268, 0.862), (0, 0.862)]
    profile = lower + beads[:4] + [(r, BAND[0]), (r, BAND[1])] + beads[4:] + upper

    def pick(i, k):
        (r0, z0), (r1, z1) = profile[i], profile[i + 1]
        if r0 == r1 == r and z1 - z0 > 0.1:
            return "panel"
        if r0 == 0 or r1 == 0:
            return "lid"
        return "paint" if max(r0, r1) == r and z0 > 0.04 and z1 < 0.84 else "hoop"
    turned(mesh, profile, sides, pick)
    mesh.faces = [f for f in mesh.faces if f[0] != "panel"]
    stripes(mesh, sides, r)
    rust = [mesh.dice.uniform(0.02, 0.13) * (1.9 if k % 11 in (2, 3, 4, 5) else 0.6) for k in range(2 * sides)]
    panel(mesh, sides, r, 0.032, HOOPS[0] - 0.026, [0.032 + h for h in rust], "rust", "paint")
    drips = [mesh.dice.uniform(0.06, 0.17) if mesh.dice.random() < 0.18 else mesh.dice.uniform(0.002, 0.02) for _ in range(2 * sides)]
    panel(mesh, sides, r, HOOPS[1] + 0.026, 0.848, [0.848 - h for h in drips], "paint", "rust")
    for angle, out, size in ((200, 0.19, 0.036), (20, 0.19, 0.020)):  # its two bungs
        center = around(angle, out)
        ring = [[add(around(60 * k, size * s, z), center) for k in range(6)] for s, z in ((1, 0.862), (0.9, 0.880))]
        since = mesh.mark()
        for k in range(6):
            mesh.face("hoop", ring[0][k], ring[0][(k + 1) % 6], ring[1][(k + 1) % 6], ring[1][k])
        mesh.face("hoop", *ring[1])
        mesh.smooth(since, 30)
    return mesh


def panel(mesh, sides, r, low, high, edge, below, above):
    """A ring of the wall in two colours; `edge`: at which height they meet, twice for each side."""
    for k in range(sides):
        a, b = around(360 * k / sides, r), around(360 * (k + 1) / sides, r)
        normals = [unit(a), unit(b)]

        def cell(name, heights):
            mesh.face(name, *[mix(a, b, t)[:2] + (z,) for t, z in heights], normals=[unit(mix(*normals, t)) for t, _ in heights])
        line = [(t / 2, edge[(2 * k + t) % len(edge)]) for t in range(3)]
        cell(below, [(0, low), (1, low)] + line[::-1])
        cell(above, line + [(1, high), (0, high)])


def stripes(mesh, sides, r):
    """Slanted stripes all round the band: an edge climbs it over two sides, and is two sides from the next."""
    low, high = BAND
    rise = (high - low) / 2
    for k in range(sides):
        a, b = around(360 * k / sides, r), around(360 * (k + 1) / sides, r)
        for m in range(k // 2 - 2, k // 2 + 2):
            foot, top = low + rise * (k - 2 * m - 2), low + rise * (k - 2 * m)
            points = clip([(0, foot), (1, foot + rise), (1, top + rise), (0, top)], low, high)
            if len(points) > 2:
                mesh.face("stripe" if m % 2 == 0 else "stripe_dark", *[mix(a, b, t)[:2] + (z,) for t, z in points],
                          normals=[unit(mix(a, b, t)) for t, _ in points])


def clip(points, low, high):
    """A polygon of (t, z), between two heights (Sutherland and Hodgman 1974)."""
    for sign, limit in ((1, low), (-1, high)):
        out = []
        for p, q in zip(points, points[1:] + points[:1]):
            dp, dq = sign * (p[1] - limit), sign * (q[1] - limit)
            if dp >= 0:
                out.append(p)
            if dp * dq < -1e-12:
                t = dp / (dp - dq)
                out.append((p[0] + (q[0] - p[0]) * t, limit))
        points = out
        if not points:
            break
    return [p for k, p in enumerate(points) if math.dist(p, points[k - 1]) > 1e-6]


def main(folder):
    barrel().write(folder, "barrel", SCRIPT, {"paint": (0.46, 0.050, 0.022), "rust": (0.17, 0.062, 0.026), "hoop": (0.30, 0.040, 0.022),
                                              "lid": (0.36, 0.045, 0.024), "stripe": (0.78, 0.46, 0.035), "stripe_dark": (0.028, 0.026, 0.026)})


main(sys.argv[1])
