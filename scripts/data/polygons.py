"""Meshes put together face by face, with the normals that whoever shapes them wants.

Smoothed by angle (Thuermer and Wuethrich 1998: weighted by the angle of the corner), or bent towards
a direction, as foliage wants it: a crown of flat leaves that is lit as one round mass.
"""
import math
import random


def add(a, b, factor=1.0):
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(dot(v, v))
    return (v[0] / length, v[1] / length, v[2] / length) if length > 0 else (0.0, 0.0, 1.0)


def around(angle, radius, z=0.0, center=(0.0, 0.0)):
    """The point at an angle (degrees) of a circle."""
    a = math.radians(angle)
    return (center[0] + radius * math.cos(a), center[1] + radius * math.sin(a), z)


class Mesh:
    """Faces, each a list [material, points, normals or None]; what was added since a mark can be made smooth."""

    def __init__(self, seed):
        self.faces = []
        self.dice = random.Random(seed)

    def face(self, material, *points, normals=None):
        self.faces.append([material, list(points), normals])

    def mark(self):
        return len(self.faces)

    def flat_normal(self, face):
        """Newell's: of a face that is not quite plane, too."""
        n, points = (0.0, 0.0, 0.0), face[1]
        for a, b in zip(points, points[1:] + points[:1]):
            n = add(n, cross(a, b))
        return unit(n)

    def smooth(self, since, degrees):
        """One normal for the corners at a point whose faces turn by less than that."""
        limit, at = math.cos(math.radians(degrees)), {}
        for face in self.faces[since:]:
            n = self.flat_normal(face)
            for k, p in enumerate(face[1]):
                u, v = (unit(add(face[1][j % len(face[1])], p, -1)) for j in (k - 1, k + 1))
                weight = math.acos(max(-1.0, min(1.0, dot(u, v))))
                at.setdefault(key(p), []).append((n, weight))
        for face in self.faces[since:]:
            n, normals = self.flat_normal(face), []
            for p in face[1]:
                total = (0.0, 0.0, 0.0)
                for other, weight in at[key(p)]:
                    if dot(n, other) > limit:
                        total = add(total, other, weight)
                normals.append(unit(total))
            face[2] = normals

    def bend(self, since, towards, share):
        """Normals a share of the way towards what `towards(point)` says."""
        for face in self.faces[since:]:
            normals = face[2] or [self.flat_normal(face)] * len(face[1])
            face[2] = [unit(mix(n, unit(towards(p)), share)) for n, p in zip(normals, face[1])]

    def write(self, folder, name, script, materials):
        """NAME.obj and NAME.mtl; materials: {name: color} or {name: (color, emission)}, linear."""
        with open("%s/%s.mtl" % (folder, name), "w") as out:
            for label, color in materials.items():
                out.write("newmtl %s\n" % label)
                if isinstance(color[0], tuple):
                    out.write("Kd %g %g %g\nKe %g %g %g\n" % (color[0] + color[1]))
                else:
                    out.write("Kd %g %g %g\n" % color)
        points, normals, lines = {}, {}, []
        for label in materials:
            lines.append("usemtl %s" % label)
            for face in (f for f in self.faces if f[0] == label):
                own = face[2] or [self.flat_normal(face)] * len(face[1])
                corners = ["%d//%d" % (points.setdefault("v %.3f %.3f %.3f" % p, len(points) + 1),
                                       normals.setdefault("vn %.2f %.2f %.2f" % n, len(normals) + 1))
                           for p, n in zip(face[1], own)]
                if len(set(corners)) == len(corners):
                    lines.append("f " + " ".join(corners))
        with open("%s/%s.obj" % (folder, name), "w") as out:
            out.write("# Made by scripts/data/%s. Z up, metres.\nmtllib %s.mtl\n" % (script, name))
            out.write("\n".join(list(points) + list(normals) + lines).replace("-0.00 ", "0.00 ") + "\n")
        count = sum(len(f[1]) - 2 for f in self.faces)
        print("%s: %d triangles, %d materials" % (name, count, len(materials)))


def key(p):
    return (round(p[0], 4), round(p[1], 4), round(p[2], 4))


def tube(mesh, joints, sides, pick, rough=0.0, tip="point", since=None):
    """A bent cone through joints (x, y, z, radius). pick(ring, side) names a face's material. tip: point, or
    broken, which leaves splinters."""
    first = mesh.mark() if since is None else since
    up, rings = None, []
    turn = mesh.dice.uniform(0, 360)
    for i, joint in enumerate(joints):
        before, after = joints[max(i - 1, 0)], joints[min(i + 1, len(joints) - 1)]
        along = unit(add(after[:3], before[:3], -1))
        if up is None:
            up = (1.0, 0.0, 0.0) if abs(along[0]) < 0.9 else (0.0, 1.0, 0.0)
        side = unit(cross(along, up))
        up = cross(side, along)  # carried along: the tube does not twist
        ring = []
        for k in range(sides):
            a = math.radians(turn + 360 * k / sides)
            r = joint[3] * (1 + rough * mesh.dice.uniform(-1, 1))
            ring.append(add(add(joint[:3], side, -r * math.cos(a)), up, r * math.sin(a)))
        rings.append(ring)
    for i in range(len(rings) - 1):
        for k in range(sides):
            j = (k + 1) % sides
            mesh.face(pick(i, k), rings[i][k], rings[i][j], rings[i + 1][j], rings[i + 1][k])
    end, last = joints[-1], rings[-1]
    along = unit(add(end[:3], joints[-2][:3], -1))
    mesh.smooth(first, 60)
    cap = mesh.mark()
    for k in range(sides):
        j = (k + 1) % sides
        if tip == "broken":
            out = add(mix(last[k], last[j], 0.5), along, end[3] * mesh.dice.uniform(0.3, 2.6))
            mesh.face(pick(len(rings) - 2, k), last[k], last[j], out)
            mesh.face(pick(-1, k), last[j], add(end[:3], along, 0.3 * end[3]), out)
            mesh.face(pick(-1, k), last[k], out, add(end[:3], along, 0.3 * end[3]))
        else:
            mesh.face(pick(-1, k), last[k], last[j], add(end[:3], along, 0.6 * end[3]))
    if tip != "broken":
        mesh.smooth(cap, 60)
