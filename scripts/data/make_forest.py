#!/usr/bin/env python3
"""Write the trees of a forest, green and burnt, and what lies between them: effects/data/pine.obj,
leafy.obj, pine_burnt.obj, leafy_burnt.obj, stump.obj, rock.obj, fern.obj, tuft.obj.

  /usr/bin/python3 scripts/data/make_forest.py effects/data
"""
import math
import sys

sys.dont_write_bytecode = True
import numpy as np
from polygons import Mesh, add, around, dot, mix, tube, unit
import shapes
import surface

SCRIPT = "make_forest.py"
BARK, BARK_LIGHT = (0.115, 0.062, 0.036), (0.20, 0.115, 0.062)
CHAR, ASH, EMBER = (0.022, 0.019, 0.018), (0.068, 0.061, 0.057), ((0.30, 0.06, 0.01), (5.0, 1.1, 0.12))
CUT, CUT_DARK = (0.52, 0.33, 0.16), (0.33, 0.18, 0.08)


def trunk(mesh, joints, sides, names, flare):
    """A stem whose foot widens into roots, lighter on some of its sides."""
    tube(mesh, [(x, y, z, r * (1 + flare * max(0, 1 - z / 0.5) ** 2)) for x, y, z, r in joints], sides,
         lambda i, k: names[(k * 5 + i * 2) % 7 > 4], 0.10)


# ---- a pine ------------------------------------------------------------------------------------------

def skirt(mesh, center, low, height, radius, tips):
    """One storey of branches: they hang down, end ragged, and are dark below."""
    dice = mesh.dice
    phase = dice.uniform(0, 360)
    apex = (center[0] + dice.uniform(-0.03, 0.03), center[1] + dice.uniform(-0.03, 0.03), low + height)
    middle, outer = [], []
    for k in range(2 * tips):
        angle = phase + 180 * k / tips + dice.uniform(-0.22, 0.22) * 180 / tips
        if k % 2 == 0:
            reach = radius * dice.uniform(0.80, 1.15)
            hang = low - 0.10 * height * dice.uniform(0, 1.8)
        else:
            reach, hang = 0.66 * radius * dice.uniform(0.9, 1.1), low + 0.20 * height
        outer.append(around(angle, reach, hang, center))
        middle.append(around(angle, radius * (0.46 if k % 2 == 0 else 0.37), low + (0.46 if k % 2 == 0 else 0.41) * height,
                             center))
    inside = (center[0], center[1], low + 0.36 * height)
    since = mesh.mark()
    for k in range(2 * tips):
        j = (k + 1) % (2 * tips)
        mesh.face("needles", apex, middle[k], middle[j])
        tip = k if k % 2 == 0 else j
        notch = j if tip == k else k
        light = "needles_light" if (k // 2 * 7 + 3) % 5 < 2 else "needles"
        if tip == k:
            mesh.face(light, middle[k], outer[k], middle[j])
            mesh.face("needles", middle[notch], outer[tip], outer[notch])
        else:
            mesh.face(light, middle[j], middle[k], outer[j])
            mesh.face("needles", middle[notch], outer[notch], outer[tip])
    mesh.smooth(since, 35)
    mesh.bend(since, lambda p: (p[0] - center[0], p[1] - center[1], 0.55 * radius), 0.45)
    since = mesh.mark()
    for k in range(2 * tips):
        mesh.face("needles_dark", inside, outer[(k + 1) % (2 * tips)], outer[k])
    mesh.bend(since, lambda p: (p[0] - center[0], p[1] - center[1], -1.5 * radius), 0.5)


def lean(z, height):
    """Where the stem is: a young tree grew towards a gap."""
    t = z / height
    return (0.16 * math.sin(2.2 * t) * t, -0.10 * t * t)


def pine(seed=5):
    mesh, height = Mesh(seed), 6.2
    stem = [lean(z, height) + (z, r) for z, r in
            ((-0.08, 0.22), (0.18, 0.19), (0.55, 0.165), (1.4, 0.14), (3.2, 0.09), (5.2, 0.035))]
    trunk(mesh, stem, 8, ("bark", "bark_light"), 0.5)
    storeys = 8
    for k in range(storeys):
        t = k / (storeys - 1)
        low = 0.72 + 4.55 * t ** 0.93
        radius = (1.62 * (1 - t) ** 0.82 + 0.30) * (1.08 if k % 2 == 0 else 0.93) * mesh.dice.uniform(0.95, 1.05)
        rise = 1.45 - 0.40 * t
        skirt(mesh, lean(low, height), low, rise, radius, round(9 - 4 * t))
    return mesh


# ---- a leafy tree ------------------------------------------------------------------------------------

CLUMPS = (  # center, radii
    ((0.05, 0.00, 4.15), (1.05, 1.00, 0.85)), ((0.85, 0.30, 3.45), (0.95, 0.85, 0.72)),
    ((-0.80, 0.45, 3.55), (0.88, 0.90, 0.74)), ((-0.35, -0.85, 3.30), (0.90, 0.80, 0.68)),
    ((0.60, -0.70, 3.05), (0.78, 0.72, 0.58)), ((-1.30, -0.25, 2.85), (0.66, 0.62, 0.48)),
    ((1.42, -0.10, 2.80), (0.62, 0.60, 0.46)), ((0.10, 1.10, 2.95), (0.80, 0.66, 0.58)),
)


def clump_of(p):
    """The clump nearest to a point, and the direction out of it."""
    best = min(CLUMPS, key=lambda c: sum(((x - y) / r) ** 2 for x, y, r in zip(p, c[0], c[1])))
    return unit(tuple((x - y) / (r * r) for x, y, r in zip(p, best[0], best[1])))


def crown(mesh, triangles):
    def knobs(p):
        d = shapes.join(0.10, *(shapes.ellipsoid(c, r) for c, r in CLUMPS))(p)
        return d + 0.07 * np.sin(5.1 * p[:, 0] + 1) * np.sin(4.7 * p[:, 1]) * np.sin(5.3 * p[:, 2] + 2)
    vertices, faces, _ = surface.build(knobs, (-2.3, -2.1, 1.9), (2.4, 2.2, 5.4), 0.13, triangles)
    since = mesh.mark()
    for f in faces:
        corners = [tuple(float(x) for x in vertices[k]) for k in f]
        middle = tuple(sum(c[i] for c in corners) / 3 for i in range(3))
        out = clump_of(middle)
        lit = out[2] + 0.22 * (middle[2] - 3.5) + mesh.dice.uniform(-0.16, 0.16)
        mesh.face("leaves_light" if lit > 0.62 else "leaves" if lit > -0.28 else "leaves_dark", *corners)
    mesh.smooth(since, 50)
    mesh.bend(since, clump_of, 0.5)
    return mesh.faces[since:]


def leaves(mesh, faces, count):
    """Single leaves that stand off the crown, so that its outline is one of leaves."""
    areas = [abs(np.linalg.norm(np.cross(np.subtract(f[1][1], f[1][0]), np.subtract(f[1][2], f[1][0])))) for f in faces]
    for face in mesh.dice.choices(faces, areas, k=count):
        u, v = mesh.dice.random(), mesh.dice.random()
        if u + v > 1:
            u, v = 1 - u, 1 - v
        foot = add(add(face[1][0], add(face[1][1], face[1][0], -1), u), add(face[1][2], face[1][0], -1), v)
        out = clump_of(foot)
        aside = (mesh.dice.gauss(0, 1), mesh.dice.gauss(0, 1), mesh.dice.gauss(-0.6, 0.7))
        along = unit(add(unit(add(aside, out, -dot(aside, out))), out, mesh.dice.uniform(0.25, 0.95)))  # like shingles that stand off
        across = unit(np.cross(along, out).tolist())
        length, half = mesh.dice.uniform(0.22, 0.36), mesh.dice.uniform(0.06, 0.105)
        start, end = add(foot, along, -0.06), add(foot, along, length)
        waist = mix(start, end, 0.45)
        a, b = add(waist, across, half), add(waist, across, -half)
        if dot(np.cross(np.subtract(a, start), np.subtract(end, start)).tolist(), out) < 0:
            a, b = b, a
        mesh.face(face[0], start, a, end, b, normals=[out] * 4)


FORK = (  # of the leafy tree: joints of its stem and of the boughs that carry the clumps
    ((0.00, 0.00, -0.08, 0.27), (0.03, 0.02, 0.22, 0.215), (0.06, 0.02, 0.8, 0.175), (0.00, -0.03, 1.5, 0.15),
     (0.02, 0.0, 2.3, 0.12), (0.05, 0.0, 3.4, 0.05)),
    ((0.02, 0.0, 1.45, 0.10), (0.32, 0.10, 2.0, 0.085), (0.85, 0.25, 2.9, 0.04)),
    ((0.02, 0.0, 1.65, 0.09), (-0.35, 0.10, 2.25, 0.075), (-0.8, 0.38, 3.0, 0.04)),
    ((0.02, 0.0, 1.85, 0.08), (-0.12, -0.40, 2.35, 0.065), (-0.3, -0.8, 2.9, 0.035)),
    ((0.30, 0.10, 1.95, 0.055), (0.9, 0.0, 2.25, 0.045), (1.35, -0.08, 2.6, 0.03)),
    ((-0.34, 0.10, 2.2, 0.05), (-0.9, -0.15, 2.45, 0.04), (-1.25, -0.22, 2.7, 0.03)),
)


def leafy(seed=3):
    mesh = Mesh(seed)
    trunk(mesh, FORK[0], 8, ("bark", "bark_light"), 0.6)
    for bough in FORK[1:]:
        tube(mesh, bough, 5, lambda i, k: "bark")
    leaves(mesh, crown(mesh, 560), 230)
    return mesh


# ---- what is left of them ------------------------------------------------------------------------------

def cracks(mesh, joints, count):
    """Slits in a charred stem that still glow: slivers just above its surface."""
    for _ in range(count):
        i = mesh.dice.randrange(len(joints) - 1)
        at = mix(joints[i], joints[i + 1], mesh.dice.random())
        angle, tall, wide = mesh.dice.uniform(0, 360), mesh.dice.uniform(0.06, 0.24), mesh.dice.uniform(3, 11)
        radius = at[3] * 1.09 + 0.004
        a, b = (around(angle + s, radius, at[2] + mesh.dice.uniform(-0.03, 0.03), at) for s in (-wide, wide))
        top, foot = (around(angle + mesh.dice.uniform(-6, 6), radius, at[2] + s * tall, at) for s in (1, -1))
        mesh.face("ember", foot, b, top, a)


def charred(i, k):
    return "ash" if (3 * i + 2 * k) % 7 == 0 else "char"


def bough(mesh, foot, direction, length, radius, twigs, sag):
    """A bare branch: bent, ever thinner, with twigs on it."""
    dice, joints, at, way = mesh.dice, [], foot, unit(direction)
    steps = 3
    for k in range(steps + 1):
        joints.append(at + (radius * (1 - 0.78 * k / steps),))
        way = unit(add(way, (dice.uniform(-0.28, 0.28), dice.uniform(-0.28, 0.28), dice.uniform(-0.2, 0.2) - sag)))
        at = add(at, way, length / steps)
    tube(mesh, joints, 5 if radius > 0.045 else 4, charred, 0.08)
    for k in range(twigs):
        t = (k + 1.0) / (twigs + 0.6)
        i = min(int(t * steps), steps - 1)
        start = mix(joints[i], joints[i + 1], t * steps - i)
        way = unit(add(joints[i + 1][:3], joints[i][:3], -1))
        side = unit((dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(-0.3, 0.8)))
        reach = length * dice.uniform(0.25, 0.45)
        tip = add(add(start[:3], way, 0.6 * reach), side, 0.8 * reach)
        thin = max(start[3] * 0.65, 0.014)
        knee = add(mix(start[:3], tip, 0.5), (dice.uniform(-0.05, 0.05), dice.uniform(-0.05, 0.05), 0.05))
        tube(mesh, [start[:3] + (thin,), knee + (0.7 * thin,), tip + (0.3 * thin,)], 3, charred)


def pine_burnt(seed=8):
    mesh, height = Mesh(seed), 6.2
    stem = [lean(z, height) + (z, r) for z, r in
            ((-0.08, 0.20), (0.2, 0.175), (0.6, 0.15), (1.4, 0.125), (2.6, 0.10), (3.8, 0.07), (4.75, 0.042))]
    flared = [(x, y, z, r * (1 + 0.5 * max(0, 1 - z / 0.5) ** 2)) for x, y, z, r in stem]
    tube(mesh, flared, 8, charred, 0.10, "broken")
    cracks(mesh, stem[1:], 16)
    angle = 0.0
    for k in range(25):
        t = k / 24
        z, angle = 0.85 + 3.65 * t, angle + 137.5 + mesh.dice.uniform(-25, 25)  # the golden angle: no two above each other
        center = lean(z, height)
        reach = (1.25 * (1 - t) ** 0.8 + 0.26) * mesh.dice.uniform(0.4, 1.1)
        way = around(angle, 1, mesh.dice.uniform(-0.1, 0.35))
        bough(mesh, around(angle, 0.05, z, center), way, reach, 0.052 - 0.022 * t, 2 if reach > 0.7 else 1 if reach > 0.4 else 0, 0.17)
    return mesh


def leafy_burnt(seed=12):
    mesh = Mesh(seed)
    stem = [(x, y, z, 0.93 * r * (1 + 0.6 * max(0, 1 - z / 0.5) ** 2)) for x, y, z, r in FORK[0]]
    tube(mesh, stem, 8, charred, 0.10, "broken")
    cracks(mesh, FORK[0][1:5], 15)
    for joints in FORK[1:]:
        thin = [(x, y, z, 0.9 * r) for x, y, z, r in joints]
        tube(mesh, thin, 5, charred, 0.06)
        for k in range(4):
            t = 0.35 + 0.2 * k
            i = 0 if t < 0.5 else 1
            start = mix(thin[i], thin[i + 1], 2 * t - i)
            way = unit(add(thin[i + 1][:3], thin[i][:3], -1))
            side = (mesh.dice.uniform(-1, 1), mesh.dice.uniform(-1, 1), mesh.dice.uniform(0.0, 0.7))
            bough(mesh, start[:3], add(way, side, 1.1), mesh.dice.uniform(0.45, 0.95), max(0.6 * start[3], 0.024), 1 + k % 2, -0.06)
    for k in range(3):
        bough(mesh, FORK[0][4][:3], (mesh.dice.uniform(-1, 1), mesh.dice.uniform(-1, 1), 1.1), 1.0, 0.05, 2, -0.05)
    return mesh


# ---- the floor -----------------------------------------------------------------------------------------

def stump(seed=2):
    """What was left of a felled tree: five roots, a cut with rings, and the splinter where it broke off."""
    mesh, sides = Mesh(seed), 15
    rings = []
    for z, radius in ((-0.06, 0.50), (0.05, 0.44), (0.16, 0.335), (0.34, 0.30), (0.44, 0.305)):
        ring = []
        for k in range(sides):
            root = max(0.0, math.cos(math.radians(5 * 24 * k + 40))) * max(0, 1 - z / 0.2)
            ring.append(around(24 * k, radius * (1 + 0.55 * root) * mesh.dice.uniform(0.96, 1.04), z + (0.03 if z > 0.4 else 0) *
                               math.cos(math.radians(24 * k - 60))))
        rings.append(ring)
    for i in range(len(rings) - 1):
        for k in range(sides):
            j = (k + 1) % sides
            moss = i == 1 and k % 15 in (3, 4, 5, 9)
            mesh.face("moss" if moss else "bark_light" if (k * 4 + i) % 9 < 2 else "bark", rings[i][k], rings[i][j],
                      rings[i + 1][j], rings[i + 1][k])
    mesh.smooth(0, 40)
    top = rings[-1]
    for t0, t1, name in ((1, 0.86, "bark"), (0.86, 0.62, "cut"), (0.62, 0.52, "cut_dark"), (0.52, 0.28, "cut"),
                         (0.28, 0.18, "cut_dark"), (0.18, 0, "cut")):
        heart = (0.03, -0.02, 0.445)
        for k in range(sides):
            j = (k + 1) % sides
            points = [mix(heart, top[k], t0), mix(heart, top[j], t0), mix(heart, top[j], t1), mix(heart, top[k], t1)]
            mesh.face(name, *(points if t1 else points[:3]))
    for k in (11, 12):  # the hinge that tore
        a, b = mix((0, 0, 0.44), top[k], 0.9), mix((0, 0, 0.44), top[k + 1], 0.9)
        peak = add(mix(a, b, 0.5), (0.0, 0.0, mesh.dice.uniform(0.10, 0.16)))
        inner = mix((0, 0, 0.44), mix(top[k], top[k + 1], 0.5), 0.7)
        for u, v in ((a, b), (b, inner), (inner, a)):
            mesh.face("cut", u, v, peak)
    return mesh


def rock(seed=6):
    """A boulder, broken along planes, with moss where rain stays."""
    mesh = Mesh(seed)
    planes = [(unit((mesh.dice.gauss(0, 1), mesh.dice.gauss(0, 1), mesh.dice.gauss(0.1, 0.8))), mesh.dice.uniform(0.72, 0.95))
              for _ in range(22)]

    def broken(p):
        q = (p - np.array((0, 0, 0.22))) / np.array((0.60, 0.50, 0.52))
        d = shapes.norm(q) - 1
        for n, at in planes:
            d = np.maximum(d, q @ np.array(n) - at)
        return 0.42 * d
    vertices, faces, _ = surface.build(broken, (-0.8, -0.8, -0.4), (0.8, 0.8, 0.9), 0.045, 150)
    for f in faces:
        corners = [tuple(float(x) for x in vertices[k]) for k in f]
        n = unit(np.cross(np.subtract(corners[1], corners[0]), np.subtract(corners[2], corners[0])).tolist())
        mesh.face("moss" if n[2] > 0.80 else "stone_light" if n[2] > 0.35 else "stone", *corners)
    mesh.smooth(0, 18)
    return mesh


def frond(mesh, angle, length, rise, width, steps, name):
    """A blade that bends over, folded along its rib."""
    since, last = mesh.mark(), None
    for k in range(steps + 1):
        t = k / steps
        along = length * (t - 0.12 * t * t)
        z = rise * (1.9 * t - 1.35 * t * t)
        half = width * (0.35 + 1.6 * t - 1.95 * t * t) if k < steps else 0.0
        rib = around(angle, along, z)
        sides = [add(around(angle + s * 90, half), rib) for s in (1, -1)]
        sides = [(p[0], p[1], p[2] - 0.35 * half) for p in sides]
        if last:
            for i, (p, q) in enumerate(zip(last[1], sides)):
                quad = (last[0], p, q, rib) if i else (last[0], rib, q, p)
                mesh.face(name, *(quad if k < steps else ((last[0], p, rib) if i else (last[0], rib, p))))
        last = (rib, sides)
    mesh.bend(since, lambda p: (0.4 * p[0], 0.4 * p[1], 1.0), 0.7)


def fern(seed=4):
    """A shuttlecock of fronds, whose leaflets are teeth along the rib."""
    mesh = Mesh(seed)
    for i in range(9):
        angle, length = 40 * i + mesh.dice.uniform(-12, 12), mesh.dice.uniform(0.42, 0.60)
        rise, name = mesh.dice.uniform(0.26, 0.42), "fern" if i % 3 else "fern_light"
        since, teeth = mesh.mark(), 9
        for k in range(teeth):
            t, u = k / teeth, (k + 1) / teeth
            ribs = [add(around(angle, length * (x - 0.10 * x * x)), (0, 0, rise * (1.9 * x - 1.35 * x * x))) for x in (t, u)]
            half = 0.115 * (0.25 + 1.9 * t - 2.1 * t * t)
            for s in (1, -1):
                tip = add(add(mix(ribs[0], ribs[1], 0.75), around(angle + s * 62, half)), (0, 0, -0.3 * half))
                mesh.face(name, *((ribs[0], ribs[1], tip) if s > 0 else (ribs[0], tip, ribs[1])))
        mesh.bend(since, lambda p: (0.5 * p[0], 0.5 * p[1], 0.6), 0.7)
    return mesh


def tuft(seed=9):
    """Grass."""
    mesh = Mesh(seed)
    for i in range(22):
        angle, length = 137.5 * i, mesh.dice.uniform(0.08, 0.30)
        frond(mesh, angle, length, mesh.dice.uniform(0.30, 0.75), 0.028, 3, "grass_light" if i % 4 == 0 else "grass")
    return mesh


def main(folder):
    wood = {"bark": BARK, "bark_light": BARK_LIGHT}
    burnt = {"char": CHAR, "ash": ASH, "ember": EMBER}
    pine().write(folder, "pine", SCRIPT, {**wood, "needles_dark": (0.016, 0.062, 0.040), "needles": (0.034, 0.125, 0.058),
                                          "needles_light": (0.070, 0.205, 0.072)})
    leafy().write(folder, "leafy", SCRIPT, {**wood, "leaves_dark": (0.040, 0.105, 0.022), "leaves": (0.105, 0.215, 0.035),
                                            "leaves_light": (0.225, 0.335, 0.055)})
    pine_burnt().write(folder, "pine_burnt", SCRIPT, burnt)
    leafy_burnt().write(folder, "leafy_burnt", SCRIPT, burnt)
    stump().write(folder, "stump", SCRIPT, {**wood, "cut": CUT, "cut_dark": CUT_DARK, "moss": (0.075, 0.14, 0.028)})
    rock().write(folder, "rock", SCRIPT, {"stone": (0.135, 0.135, 0.145), "stone_light": (0.235, 0.230, 0.225), "moss": (0.085, 0.15, 0.03)})
    fern().write(folder, "fern", SCRIPT, {"fern": (0.045, 0.16, 0.035), "fern_light": (0.10, 0.26, 0.05)})
    tuft().write(folder, "tuft", SCRIPT, {"grass": (0.095, 0.175, 0.035), "grass_light": (0.22, 0.29, 0.065)})


main(sys.argv[1])
