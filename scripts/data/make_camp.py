#!/usr/bin/env python3
"""Write effects/data/barrel.obj, a drum of oil that has stood outside for long, and a camp in the woods:
tent.obj, axe.obj, stick.obj.

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


# ---- a camp ------------------------------------------------------------------------------------------

def sheet(mesh, name, corner, across, up, sag):
    """Canvas between a corner and two edges, in 4 x 3 pieces that hang in a little: `sag` is that of its middle."""
    since = mesh.mark()

    def at(i, k):
        u, v = i / 4, k / 3
        p = add(add(corner, across, u), up, v)
        deep = 16 * u * (1 - u) * v * (1 - v)
        return add(p, sag, deep)
    for i in range(4):
        for k in range(3):
            mesh.face(name, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1))
    mesh.smooth(since, 60)


def tent(seed=1):
    """A ridge tent, open towards -Y, one of its flaps turned back."""
    mesh, wide, high, deep = Mesh(seed), 1.0, 1.4, 1.25
    front, back = (0, -deep, high), (0, deep, high)
    for side in (1, -1):
        foot = (side * wide, -deep * side, 0)  # each sheet runs so that it faces outwards
        sheet(mesh, "canvas" if side > 0 else "canvas_light", foot, (0, 2 * deep * side, 0), (-side * wide, 0, high), (-side * 0.07, 0, -0.05))
        low, top = [(side * (wide + 0.012), side * y * deep, 0.0) for y in (-1, 1)], [(side * (wide - 0.13), side * y * deep, 0.2) for y in (-1, 1)]
        mesh.face("hem", low[0], low[1], top[1], top[0])
    mesh.face("canvas_dark", (wide, deep, 0), (-wide, deep, 0), back)
    mesh.face("canvas_light", (-wide, -deep, 0), (-0.04, -deep - 0.03, 0), add(front, (0, -0.01, -0.02)))
    fold = (0.66, -deep - 0.30, 0.02)  # the other flap, turned outwards
    mesh.face("canvas_dark", (wide, -deep, 0), add(front, (0.02, 0, -0.03)), fold)
    mesh.face("hem", fold, add(front, (0.02, 0, -0.03)), (0.55, -deep - 0.34, 0.0))
    mesh.face("floor", (-wide, -deep, 0.012), (wide, -deep, 0.012), (wide, deep, 0.012), (-wide, deep, 0.012))
    for y in (-deep, deep):
        out = 1 if y > 0 else -1
        tube(mesh, [(0, y, -0.05, 0.026), (0, y, 0.7, 0.026), (0, y, high + 0.14, 0.022)], 6, lambda i, k: "pole")
        peg = (0.12, y + out * 1.05, 0.0)
        tube(mesh, [(0, y, high + 0.05, 0.009), mix((0, y, high), peg, 0.5)[:2] + (0.55 * high, 0.009), peg + (0.009,)], 4, lambda i, k: "rope")
        tube(mesh, [peg[:2] + (-0.05, 0.022), add(peg, (0, out * 0.05, 0.12)) + (0.018,)], 5, lambda i, k: "pole")
    tube(mesh, [(0, -deep - 0.12, high, 0.022), (0, 0, high - 0.03, 0.022), (0, deep + 0.12, high, 0.022)], 6, lambda i, k: "pole")
    return mesh


def axe(seed=1):
    """An axe whose edge is at the origin, as it sticks in a block, its handle towards +X and up."""
    mesh = Mesh(seed)
    handle = [(0.03, 0, 0.17), (0.22, 0, 0.27), (0.42, 0, 0.36), (0.58, 0, 0.40), (0.64, 0, 0.40)]
    tube(mesh, [p + (r,) for p, r in zip(handle, (0.021, 0.019, 0.018, 0.021, 0.025))], 7, lambda i, k: "handle")
    side = [(-0.075, -0.035), (0.075, -0.015), (0.062, 0.10), (0.075, 0.215), (-0.005, 0.225), (-0.02, 0.10)]  # of the head, from its edge on
    since = mesh.mark()
    for s in (1, -1):
        thick = [0.003, 0.003, 0.026, 0.030, 0.030, 0.026]
        points = [(x, s * t, z) for (x, z), t in zip(side, thick)]
        edge, poll = [points[0], points[1], points[2], points[5]], [points[5], points[2], points[3], points[4]]
        mesh.face("edge", *(edge if s < 0 else edge[::-1]))
        mesh.face("steel", *(poll if s < 0 else poll[::-1]))
    for i, j in ((1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (0, 1)):
        a, b, ta, tb = side[i], side[j], thick[i], thick[j]
        mesh.face("steel", (a[0], -ta, a[1]), (b[0], -tb, b[1]), (b[0], tb, b[1]), (a[0], ta, a[1]))
    mesh.smooth(since, 20)
    return mesh


def stick(seed=3):
    """A twig with two marshmallows, stuck in the ground at the origin and leaning along +X."""
    mesh = Mesh(seed)
    bend = [(-0.05, 0, -0.10), (0.18, 0.01, 0.26), (0.46, -0.02, 0.56), (0.76, 0.0, 0.76), (1.02, 0.02, 0.86)]
    tube(mesh, [p + (r,) for p, r in zip(bend, (0.016, 0.015, 0.013, 0.010, 0.006))], 5, lambda i, k: "bark")
    tube(mesh, [(0.46, -0.02, 0.56, 0.008), (0.52, -0.10, 0.66, 0.004)], 4, lambda i, k: "bark")
    along = unit(add(bend[4], bend[3], -1))
    for at, name in ((0.35, "toasted"), (0.72, "sweet")):
        middle, ring = mix(bend[3], bend[4], at), []
        for d, r in ((-0.042, 0.0), (-0.040, 0.026), (-0.028, 0.034), (0.028, 0.034), (0.040, 0.026), (0.042, 0.0)):
            ring.append(add(middle, along, d) + (max(r, 0.002),))
        tube(mesh, ring, 9, lambda i, k, name=name: name)
    return mesh


def main(folder):
    barrel().write(folder, "barrel", SCRIPT, {"paint": (0.46, 0.050, 0.022), "rust": (0.17, 0.062, 0.026), "hoop": (0.30, 0.040, 0.022),
                                              "lid": (0.36, 0.045, 0.024), "stripe": (0.78, 0.46, 0.035), "stripe_dark": (0.028, 0.026, 0.026)})
    tent().write(folder, "tent", SCRIPT, {"canvas": (0.50, 0.215, 0.055), "canvas_light": (0.62, 0.30, 0.085), "canvas_dark": (0.20, 0.085, 0.03),
                                          "hem": (0.27, 0.10, 0.035), "floor": (0.055, 0.06, 0.045), "pole": (0.26, 0.16, 0.075), "rope": (0.52, 0.45, 0.30)})
    axe().write(folder, "axe", SCRIPT, {"handle": (0.42, 0.235, 0.09), "steel": (0.115, 0.125, 0.145), "edge": (0.50, 0.53, 0.58)})
    stick().write(folder, "stick", SCRIPT, {"bark": (0.17, 0.095, 0.05), "toasted": (0.72, 0.43, 0.19), "sweet": (0.86, 0.80, 0.70)})


main(sys.argv[1])
