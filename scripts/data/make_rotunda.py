#!/usr/bin/env python3
"""Write effects/data/rotunda.obj and rotunda_floor.obj: a ruined ring of columns around a basin, on wet
flagstones.

  /usr/bin/python3 scripts/data/make_rotunda.py effects/data
"""
import math
import sys

sys.dont_write_bytecode = True
from polygons import Mesh, add, around, cross, dot, mix, unit

SCRIPT = "make_rotunda.py"
COLUMNS, RING, HEIGHT = 12, 6.6, 4.5  # how many, metres from the middle, up to the entablature
BROKEN = {1: 2.35, 2: 0.95, 6: 3.2, 9: 1.5}  # how high is left of a column
FLUTES = 20


def lathe(mesh, material, profile, sides, center=(0.0, 0.0), degrees=35, first=0.0, arc=360.0):
    """A profile of (radius, z), from below, about a vertical axis; seen from outside."""
    since = mesh.mark()
    for k in range(sides):
        a, b = first + arc * k / sides, first + arc * (k + 1) / sides
        for (r0, z0), (r1, z1) in zip(profile, profile[1:]):
            corners = [around(a, r0, z0, center), around(b, r0, z0, center), around(b, r1, z1, center), around(a, r1, z1, center)]
            corners = [c for i, c in enumerate(corners) if c != corners[i - 1]]
            if len(corners) > 2:
                mesh.face(material, *corners)
    mesh.smooth(since, degrees)


def box(mesh, material, center, half, turn):
    """A block that stands at `center`, with its upper edges cut."""
    c, s, cut = math.cos(math.radians(turn)), math.sin(math.radians(turn)), 0.03

    def corner(x, y, z, inset):
        dx, dy = x * (half[0] - inset), y * (half[1] - inset)
        return (center[0] + c * dx - s * dy, center[1] + s * dx + c * dy, center[2] + z)
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    rings = [[corner(x, y, z, inset) for x, y in signs]
             for z, inset in ((0, 0), (half[2] - cut, 0), (half[2], cut))]
    for low, high in zip(rings, rings[1:]):
        for k in range(4):
            j = (k + 1) % 4
            mesh.face(material, low[k], low[j], high[j], high[k])
    mesh.face(material, *rings[-1])


# ---- columns -----------------------------------------------------------------------------------------

def flute(angle):
    """Part of the shaft's radius that a flute leaves there."""
    at = (angle * FLUTES / 360.0) % 1.0
    return 1.0 - 0.062 * math.sin(math.pi * at) ** 0.7


def shaft_ring(place, z, radius, turn=0.0):
    steps = 4 * FLUTES
    return [around(turn + 360 * k / steps, radius * flute(360 * k / steps), z, place) for k in range(steps)]


def strip(mesh, material, low, high):
    for k in range(len(low)):
        j = (k + 1) % len(low)
        mesh.face(material, low[k], low[j], high[j], high[k])


def radius_at(z):
    """Thinner towards the top, with a slight swelling."""
    t = z / HEIGHT
    return 0.36 - 0.065 * t + 0.02 * math.sin(math.pi * t)


def broken_top(mesh, ring, center, rise):
    """A torn end: the edge goes up and down, and slopes inwards to a point of its own."""
    dice = mesh.dice
    torn = [add(p, (0, 0, 1), rise * (0.5 + 0.5 * math.cos(math.radians(360 * k / len(ring) + 40))) + dice.uniform(0, 0.05))
            for k, p in enumerate(ring)]
    since = mesh.mark()
    strip(mesh, "marble", ring, torn)
    mesh.smooth(since, 40)
    inner = [add(mix(p, (center[0], center[1], p[2]), 0.45), (0, 0, 1), dice.uniform(-0.06, 0.05)) for p in torn]
    strip(mesh, "break", torn, inner)
    for k in range(len(inner)):
        mesh.face("break", inner[k], inner[(k + 1) % len(inner)], (center[0], center[1], center[2] + 0.2 * rise))


def column(mesh, place, height, turn):
    box(mesh, "marble", (place[0], place[1], 0.16), (0.52, 0.52, 0.15), turn)
    base = [(0.50, 0.31), (0.52, 0.35), (0.52, 0.40), (0.47, 0.45), (0.42, 0.46), (0.41, 0.49), (0.45, 0.52), (0.45, 0.56),
            (0.40, 0.60), (0.38, 0.62), (0.36, 0.66)]
    lathe(mesh, "marble", base, 32, place)
    whole = height >= HEIGHT
    top = HEIGHT - 0.42 if whole else height
    levels = [0.66 + (top - 0.66) * k / 2 for k in range(3)]
    rings = [shaft_ring(place, z, radius_at(z)) for z in levels]
    since = mesh.mark()
    for low, high in zip(rings, rings[1:]):
        strip(mesh, "marble", low, high)
    mesh.smooth(since, 50)
    if not whole:
        broken_top(mesh, rings[-1], (place[0], place[1], top), 0.35)
        return
    capital = [(0.31, top), (0.34, top + 0.03), (0.34, top + 0.07), (0.31, top + 0.09), (0.33, top + 0.13), (0.42, top + 0.20),
               (0.47, top + 0.27)]
    lathe(mesh, "marble", capital, 32, place)
    box(mesh, "marble", (place[0], place[1], top + 0.27), (0.52, 0.52, 0.15), turn)


def drum(mesh, center, radius, length, turn, tilt):
    """A piece of a shaft that lies on the ground."""
    along = (math.cos(math.radians(turn)), math.sin(math.radians(turn)), tilt)
    along = unit(along)
    side = unit(cross((0, 0, 1), along))
    up = cross(along, side)
    steps = 4 * FLUTES

    def ring(t):
        out = []
        for k in range(steps):
            a = math.radians(360 * k / steps)
            r = radius * flute(360 * k / steps)
            out.append(add(add(add(center, along, t), side, r * math.cos(a)), up, r * math.sin(a)))
        return out
    ends = ring(-length / 2), ring(length / 2)
    since = mesh.mark()
    strip(mesh, "marble", ends[0], ends[1])
    mesh.smooth(since, 50)
    for t, loop in ((-1, list(reversed(ends[0]))), (1, ends[1])):
        middle = add(center, along, t * (length / 2 + 0.02))
        for k in range(steps):
            mesh.face("break", loop[k], loop[(k + 1) % steps], middle)


def entablature(mesh, first, last):
    """Over the columns from `first` to `last`: a beam along the ring, its ends torn."""
    profile = [(-0.36, 0.0), (-0.36, 0.34), (-0.42, 0.40), (-0.36, 0.44), (-0.36, 0.70), (-0.50, 0.78), (-0.58, 0.90), (-0.58, 0.98),
               (0.58, 0.98), (0.58, 0.90), (0.50, 0.78), (0.36, 0.70), (0.36, 0.44), (0.42, 0.40), (0.36, 0.34), (0.36, 0.0)]
    span = 360.0 / COLUMNS
    low, high = (first - 0.08) * span, (last + 0.08) * span
    steps = max(2, round((high - low) / 5))
    rings = []
    for k in range(steps + 1):
        angle = low + (high - low) * k / steps
        torn = 0.9 if k in (0, steps) else 0.0
        rings.append([around(angle + torn * mesh.dice.uniform(-1, 1), RING + r, HEIGHT + z) for r, z in profile])
    since = mesh.mark()
    for a, b in zip(rings, rings[1:]):
        for k in range(len(profile)):
            j = (k + 1) % len(profile)
            mesh.face("marble", a[j], b[j], b[k], a[k])
    mesh.smooth(since, 20)
    for ring, forward in ((rings[0], True), (rings[-1], False)):
        for k in range(len(ring) // 2 - 1):  # from the inner side to the outer, layer by layer
            across = [ring[k], ring[k + 1], ring[-2 - k], ring[-1 - k]]
            mesh.face("break", *(across if forward else reversed(across)))


def rotunda():
    mesh = Mesh(11)
    kerb = [(RING + 0.85, -0.10), (RING + 0.85, 0.0), (RING + 0.80, 0.05), (RING + 0.80, 0.13), (RING + 0.77, 0.16),
            (RING - 0.77, 0.16), (RING - 0.80, 0.13), (RING - 0.80, -0.10)]
    lathe(mesh, "stone", kerb, 96)
    for k in range(COLUMNS):
        angle = 360.0 * k / COLUMNS
        column(mesh, around(angle, RING)[:2], BROKEN.get(k, HEIGHT), angle)
    for first, last in ((3, 5), (7, 8), (10, 12)):
        entablature(mesh, first, last)
    basin = [(1.62, -0.05), (1.62, 0.10), (1.54, 0.14), (1.50, 0.20), (1.50, 0.42), (1.56, 0.50), (1.64, 0.55), (1.64, 0.62),
             (1.60, 0.65), (1.42, 0.65), (1.38, 0.61), (1.36, 0.20)]
    lathe(mesh, "marble", basin, 72)
    lathe(mesh, "water", [(1.38, 0.50), (0.0, 0.50)], 24)
    for place, radius, length, turn, tilt in (((5.0, 1.1, 0.31), 0.33, 1.2, 65, 0.02), ((4.6, 4.6, 0.30), 0.32, 0.9, 150, -0.03),
                                              ((-2.6, -4.4, 0.32), 0.34, 1.0, 20, 0.02), ((-8.4, -4.0, 0.32), 0.33, 1.5, 80, 0.0),
                                              ((3.2, 8.6, 0.31), 0.33, 1.1, 35, 0.0)):
        drum(mesh, place, radius, length, turn, tilt)
    for place, half, turn in (((8.6, 1.9, 0), (0.5, 0.42, 0.55), 25), ((-3.4, -5.2, 0), (0.34, 0.3, 0.28), 60), ((5.6, 3.4, 0.0), (0.3, 0.22, 0.3), 10),
                              ((-8.1, -2.4, 0), (0.45, 0.3, 0.4), 40), ((1.5, -9.2, 0), (0.55, 0.38, 0.45), 72)):
        box(mesh, "marble", place, half, turn)
    return mesh


# ---- the floor ---------------------------------------------------------------------------------------

def wetness(x, y):
    """Where water stands: smooth, a few metres across, 0..1."""
    v = math.sin(0.55 * x + 1.3 * math.sin(0.31 * y)) + math.sin(0.62 * y - 0.8 + 1.1 * math.sin(0.43 * x)) + 0.6 * math.sin(0.21 * (x + y))
    return min(1.0, max(0.0, 0.5 + 0.3 * v))


def flag(mesh, inner, outer, low, high):
    """A slab between two radii and two angles: a little off its level, with worn edges."""
    dice, gap, edge, deep = mesh.dice, 0.014, 0.022, 0.05
    middle = around((low + high) / 2, (inner + outer) / 2)
    tilt = (dice.gauss(0, 0.0045), dice.gauss(0, 0.0045))
    level = dice.uniform(-0.012, 0.006)

    def corner(r, angle, side_r, side_a, inset, drop):
        r += side_r * (gap + inset)
        angle += side_a * math.degrees((gap + inset) / r)
        x, y, _ = around(angle, r)
        return (x, y, level + tilt[0] * (x - middle[0]) + tilt[1] * (y - middle[1]) - drop)
    steps = max(1, round((high - low) * outer * math.pi / 180 / 0.7))
    angles = [low + (high - low) * k / steps for k in range(steps + 1)]

    def ring(inset, drop):
        sides = [1 if k == 0 else -1 if k == steps else 0 for k in range(steps + 1)]
        out = [corner(outer, a, -1, s, inset, drop) for a, s in zip(angles, sides)]
        return out + [corner(inner, a, 1, s, inset, drop) for a, s in reversed(list(zip(angles, sides)))]
    wet = wetness(middle[0], middle[1]) + dice.gauss(0, 0.10)
    material = "flag_wet" if wet > 0.52 else "flag_damp" if wet > 0.30 else "flag_dry"
    loops = [ring(0, deep), ring(0, edge), ring(edge, 0)]
    since = mesh.mark()
    for a, b in zip(loops, loops[1:]):
        for k in range(len(a)):
            j = (k + 1) % len(a)
            mesh.face(material, a[j], a[k], b[k], b[j])
    count = steps + 1
    for k in range(steps):
        mesh.face(material, loops[2][k], loops[2][2 * count - 1 - k], loops[2][2 * count - 2 - k], loops[2][k + 1])
    mesh.smooth(since, 50)


def floor():
    mesh, r = Mesh(5), 1.5
    while r < 15.5:
        width = mesh.dice.uniform(0.75, 1.15)
        count = max(8, round(2 * math.pi * (r + width / 2) / mesh.dice.uniform(1.2, 1.6)))
        turn = mesh.dice.uniform(0, 360)
        for k in range(count):
            ruined = r > 9 and mesh.dice.random() < (r - 9) / 9  # towards the edge stones are missing
            if not ruined:
                flag(mesh, r, r + width, turn + 360 * k / count, turn + 360 * (k + 1) / count)
        r += width
    lathe(mesh, "earth", [(90.0, -0.2), (40.0, -0.04), (15.0, -0.035), (1.0, -0.035)], 72, degrees=80)
    return mesh


# ---- files -------------------------------------------------------------------------------------------

def reflections(folder, name, kinds):
    """Adds specular and roughness to the .mtl: Ks, and the exponent of a highlight as wide."""
    path = "%s/%s.mtl" % (folder, name)
    with open(path) as file:
        lines = file.read().splitlines()
    out = []
    for line in lines:
        out.append(line)
        if line.startswith("newmtl"):
            specular, roughness = kinds[line.split()[1]]
            out.append("Ks %g %g %g\nNs %.1f" % (specular, specular, specular, 2 / roughness ** 4 - 2))
    with open(path, "w") as file:
        file.write("\n".join(out) + "\n")


def main():
    folder = sys.argv[1]
    rotunda().write(folder, "rotunda", SCRIPT, {"marble": (0.42, 0.40, 0.37), "break": (0.42, 0.38, 0.33), "stone": (0.13, 0.125, 0.12),
                                                "water": (0.004, 0.009, 0.011)})
    reflections(folder, "rotunda", {"marble": (0.35, 0.45), "break": (0.2, 0.8), "stone": (0.5, 0.30), "water": (0.5, 0.11)})
    floor().write(folder, "rotunda_floor", SCRIPT, {"flag_wet": (0.022, 0.023, 0.026), "flag_damp": (0.045, 0.045, 0.046),
                                                    "flag_dry": (0.085, 0.082, 0.078), "earth": (0.035, 0.031, 0.026)})
    reflections(folder, "rotunda_floor", {"flag_wet": (0.8, 0.17), "flag_damp": (0.6, 0.30), "flag_dry": (0.4, 0.5), "earth": (0.3, 0.45)})


if __name__ == "__main__":
    main()
