"""What grows on a hide, as triangles: scales that follow a signed distance, bands, horns, blades.

Nothing here is closed: the foot of each is below the surface that it stands on. A mesh of them is
to be looked at, never to be voxelised.
"""
import numpy as np

import surface

# Of a scale, seen from above: how far along it (1: its length), how far across (1: its width), and its
# height: (of the edge that stands off, of the keel). The last four are below the edge, in the hide.
OUTLINE = np.array(((-0.55, 0.0, -0.25, 0.0), (-0.12, 0.52, -0.1, 0.0), (0.30, 0.40, 0.8, 0.0), (0.56, 0.0, 1.0, 0.2),
                    (0.30, -0.40, 0.8, 0.0), (-0.12, -0.52, -0.1, 0.0), (-0.02, 0.0, 0.45, 1.0),
                    (0.27, 0.36, -0.6, 0.0), (0.52, 0.0, -0.6, 0.0), (0.27, -0.36, -0.6, 0.0)))
SCALE = np.array(((0, 6, 1), (1, 6, 2), (2, 6, 3), (3, 6, 4), (4, 6, 5), (5, 6, 0),
                  (1, 2, 7), (2, 3, 8), (2, 8, 7), (3, 4, 9), (3, 9, 8), (4, 5, 9)))


def unit(v):
    return v / np.maximum(np.sqrt((v * v).sum(axis=-1)), 1e-12)[..., None]


class Pile:
    """Triangles of many small things, each with a material."""

    def __init__(self):
        self.vertices, self.faces, self.labels, self.count = [], [], [], 0

    def add(self, vertices, faces, labels):
        """labels: one for all of the triangles, or one for each."""
        faces = np.asarray(faces)
        self.vertices.append(np.asarray(vertices, float))
        self.faces.append(faces + self.count)
        self.labels += [labels] * len(faces) if isinstance(labels, str) else list(labels)
        self.count += len(vertices)

    def mirror(self):
        """The other half of what stands at y > 0."""
        vertices, faces, labels = self.mesh()
        self.add(vertices * (1, -1, 1), faces[:, ::-1], labels)

    def mesh(self):
        return np.concatenate(self.vertices), np.concatenate(self.faces), self.labels


def onto(shape, p, step=0.004):
    """Points moved onto the surface, and its normals there."""
    for _ in range(3):
        g = surface.gradient(shape, p, step)
        move = shape(p)[:, None] * g / np.maximum((g * g).sum(axis=1), 0.05)[:, None]
        far = np.sqrt((move * move).sum(axis=1))[:, None]
        p = p - move * np.minimum(1, 0.04 / np.maximum(far, 1e-12))
    return p, unit(surface.gradient(shape, p, step))


def scales(pile, shape, at, back, width, length, lift, keel, labels):
    """Scales on a surface that overlap towards `back`: a row of arrays for each."""
    at, normal = onto(shape, at)
    back = unit(back - (back * normal).sum(axis=1)[:, None] * normal)
    across = np.cross(normal, back)
    u, v, edge, ridge = OUTLINE.T
    points = (at[:, None, :] + (length[:, None] * u)[..., None] * back[:, None, :]
              + (width[:, None] * v)[..., None] * across[:, None, :])
    points, up = onto(shape, points.reshape(-1, 3), 0.012)
    height = (lift[:, None] * edge + keel[:, None] * ridge).reshape(-1, 1)
    points = (points + height * up).reshape(len(at), len(OUTLINE), 3)
    for i, label in enumerate(labels):
        pile.add(points[i], SCALE, label)


def scatter(candidates, room, taken, dice):
    """Indices of candidates, in chance order, that keep their room from each other and from what is
    taken: (points, room)."""
    points = np.zeros((len(candidates) + len(taken[0]), 3))
    rooms = np.zeros(len(points))
    count = len(taken[0])
    points[:count], rooms[:count] = taken
    chosen = []
    for i in dice.permutation(len(candidates)):
        off = points[:count] - candidates[i]
        if ((off * off).sum(axis=1) < (0.5 * (rooms[:count] + room[i])) ** 2).any():
            continue
        points[count], rooms[count] = candidates[i], room[i]
        count += 1
        chosen.append(i)
    return np.array(chosen, int)


def sprinkle(mesh, count, dice):
    """Points all over a mesh, as many for each square metre."""
    v = mesh[0][mesh[1]]
    n = np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0])
    area = np.sqrt((n * n).sum(axis=1))
    face = dice.choice(len(v), count, p=area / area.sum())
    a, b = dice.random((2, count))
    over = a + b > 1
    a[over], b[over] = 1 - a[over], 1 - b[over]
    t = v[face]
    return t[:, 0] + a[:, None] * (t[:, 1] - t[:, 0]) + b[:, None] * (t[:, 2] - t[:, 0])


def rings(pile, ring, labels):
    """A skin over rings of points (count x sides x 3), closed by the last one's middle; labels: one for
    each gap between rings, and the tip."""
    count, sides = ring.shape[:2]
    vertices = np.vstack((ring.reshape(-1, 3), ring[-1].mean(axis=0)))
    faces, names = [], []
    for i in range(count - 1):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            faces += [(a, b, b + sides), (a, b + sides, a + sides)]
            names += [labels[i]] * 2
    last = (count - 1) * sides
    for k in range(sides):
        faces.append((last + k, last + (k + 1) % sides, len(vertices) - 1))
        names.append(labels[-1])
    pile.add(vertices, faces, names)


def tube(pile, joints, sides, labels):
    """A bent cone: (x, y, z, radius) at each joint."""
    j = np.asarray(joints, float)
    way = unit(np.gradient(j[:, :3], axis=0))
    side = np.cross(way[0], (0.0, 0.0, 1.0) if abs(way[0, 2]) < 0.9 else (1.0, 0.0, 0.0))
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = []
    for p, w in zip(j, way):
        side = unit(side - (side @ w) * w)  # carried along: it does not twist
        up = np.cross(w, side)
        ring.append(p[:3] + p[3] * (np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up))
    rings(pile, np.array(ring), labels)


def blade(pile, root, out, back, height, length, thick, labels, lean=0.8):
    """A plate of a crest, which stands in the plane of `out` and `back`, with sharp edges."""
    across = np.cross(back, out)
    rise = np.array((-0.15, 0.12, 0.36, 0.6, 0.8, 0.93))
    full = np.array((1.0, 1.0, 0.80, 0.55, 0.32, 0.13))
    round_ = np.array(((1, 0), (0.55, 0.8), (-0.3, 1), (-1, 0), (-0.3, -1), (0.55, -0.8)))  # along, across
    middle = root + height * (rise[:, None] * out + lean * (np.maximum(rise, 0) ** 1.7)[:, None] * back)
    size = full[:, None, None]
    ring = middle[:, None, :] + size * (length * round_[:, :1] * -back + thick * round_[:, 1:] * across)[None]
    ring[-1] += 0.07 * height * (out + lean * back)
    rings(pile, ring, labels)


def ball(pile, center, radii, pole, steps, sides, label):
    """An ellipsoid with one pole; label(angle from it, degrees)."""
    pole = unit(np.asarray(pole, float))
    side = unit(np.cross(pole, (0.0, 0.0, 1.0)))
    up = np.cross(side, pole)
    polar = np.radians(np.linspace(150, 180.0 / steps / 2, steps))
    angle = 2 * np.pi * np.arange(sides) / sides
    flat = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up
    ring = np.cos(polar)[:, None, None] * pole + np.sin(polar)[:, None, None] * flat[None]
    names = [label(a) for a in np.degrees((polar[1:] + polar[:-1]) / 2)] + [label(0)]
    rings(pile, np.asarray(center) + ring[:, ::-1] * np.asarray(radii), names)
