"""From a signed distance to a closed mesh of few triangles, and to an OBJ file.

Marching tetrahedra (Doi and Koide 1991, six to a cube) never leave a hole nor an edge of more than
two triangles, whatever the shape. Collapsing edges by quadric error (Garland and Heckbert 1997)
takes the triangles from where the surface is flat, and keeps it closed.
"""
import heapq
import itertools

import numpy as np

STAY = 0.002   # of a vertex's quadric: holds it where it was
SLIM = 0.003   # triangles are kept rounder: the square of height over longest side

CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))


def sample(shape, low, cell, count):
    """Distances at the points of a grid, plane by plane."""
    axes = [low[k] + cell * np.arange(count[k]) for k in range(3)]
    values = np.empty(count)
    for i, x in enumerate(axes[0]):
        y, z = np.meshgrid(axes[1], axes[2], indexing="ij")
        values[i] = shape(np.column_stack((np.full(y.size, x), y.ravel(), z.ravel()))).reshape(y.shape)
    return values


def tetrahedra(count, values):
    """Points of each tetrahedron that the surface crosses (indices into the grid), inner ones first."""
    index = np.arange(np.prod(count)).reshape(count)
    inside = (values < 0).ravel()
    corner = [index[c[0]:count[0] - 1 + c[0], c[1]:count[1] - 1 + c[1], c[2]:count[2] - 1 + c[2]].ravel()
              for c in CORNERS]
    inner = sum(inside[c].astype(int) for c in corner)
    crossed = (inner > 0) & (inner < 8)
    corner = [c[crossed] for c in corner]
    found = []
    for order in itertools.permutations((4, 2, 1)):  # Kuhn: along the axes from one end of the diagonal to the other
        path = np.cumsum((0,) + order)
        tets = np.column_stack([corner[k] for k in path])
        tets = np.take_along_axis(tets, np.argsort(~inside[tets], axis=1, kind="stable"), axis=1)
        found.append(tets)
    tets = np.concatenate(found)
    return tets, inside[tets].sum(axis=1)


def contour(shape, low, high, cell):
    """Vertices and triangles of the surface inside the box; the surface must not reach its walls."""
    low, high = np.array(low, float), np.array(high, float)
    count = tuple(np.ceil((high - low) / cell).astype(int) + 1)
    values = sample(shape, low, cell, count)
    tets, inner = tetrahedra(count, values)
    flat = values.ravel()

    pairs = []  # triangles as three crossed edges each, and whom they face: from inner to outer points
    for n, edges in ((1, (((0, 1), (0, 2), (0, 3)),)), (3, (((0, 3), (1, 3), (2, 3)),)),
                     (2, (((0, 2), (0, 3), (1, 3)), ((0, 2), (1, 3), (1, 2))))):
        t = tets[inner == n]
        for e in edges:
            pairs.append((np.stack([t[:, list(k)] for k in e], axis=1), t[:, :n].mean(axis=1), t, n))
    crossed = np.concatenate([p[0] for p in pairs])
    keys, faces = np.unique(np.sort(crossed.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    faces = faces.reshape(-1, 3)

    def place(i):
        return low + cell * np.stack(np.unravel_index(i, count), axis=-1)
    a, b = flat[keys[:, 0]], flat[keys[:, 1]]
    t = np.clip(a / (a - b), 0.02, 0.98)[:, None]
    vertices = place(keys[:, 0]) * (1 - t) + place(keys[:, 1]) * t
    out = np.concatenate([place(p[2][:, p[3]:]).mean(axis=1) - place(p[2][:, :p[3]]).mean(axis=1) for p in pairs])
    v = vertices[faces]
    wrong = np.einsum("ij,ij->i", np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]), out) < 0
    faces[wrong] = faces[wrong][:, ::-1]
    return vertices, faces


def gradient(shape, p, step):
    """Direction outwards, by central differences."""
    g = np.empty_like(p)
    for k in range(3):
        d = np.zeros(3)
        d[k] = step
        g[:, k] = shape(p + d) - shape(p - d)
    return g / (2 * step)


def settle(shape, vertices, cell):
    """Moves vertices onto the surface (Newton), by at most half a cell."""
    for _ in range(3):
        g = gradient(shape, vertices, 0.1 * cell)
        step = shape(vertices)[:, None] * g / np.maximum((g * g).sum(axis=1), 0.05)[:, None]
        length = np.sqrt((step * step).sum(axis=1))[:, None]
        vertices = vertices - step * np.minimum(1, 0.25 * cell / np.maximum(length, 1e-12))
    return vertices


def quadrics(vertices, faces, labels, seam):
    """For each vertex the ten numbers of the sum of squared distances to its planes. Where two labels
    meet, a plane upright on the surface holds the seam, with weight `seam`."""
    v = vertices[faces]
    normal = np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0])
    area = np.sqrt((normal * normal).sum(axis=1))
    normal /= np.maximum(area, 1e-20)[:, None]
    sums = np.zeros((len(vertices), 10))

    def add(at, n, point, weight):
        q = np.column_stack((n, -(n * point).sum(axis=1)))
        terms = np.stack([q[:, i] * q[:, j] for i in range(4) for j in range(i, 4)], axis=1) * weight[:, None]
        np.add.at(sums, at, terms)
    for k in range(3):
        add(faces[:, k], normal, v[:, 0], area)
        for axis in np.eye(3):  # a little of the distance to the vertex itself: where it is flat, triangles stay round
            add(faces[:, k], np.tile(axis, (len(faces), 1)), v[:, k], STAY * area)
    owner = {}
    for f, face in enumerate(faces):
        for k in range(3):
            owner[face[k], face[(k + 1) % 3]] = f
    border = [(i, j, f) for (i, j), f in owner.items() if labels[f] != labels[owner[j, i]]]
    if border:
        i, j, f = np.array(border).T
        edge = vertices[j] - vertices[i]
        side = np.cross(edge, normal[f])
        weight = (edge * edge).sum(axis=1) * seam
        side /= np.maximum(np.sqrt((side * side).sum(axis=1)), 1e-20)[:, None]
        for at in (i, j):
            add(at, side, vertices[i], weight)
    return sums.tolist()


def best_point(q, a, b):
    """Where the quadric is least, and how much that is: solved, or the best of the ends and the middle."""
    q00, q01, q02, q03, q11, q12, q13, q22, q23, q33 = q

    def cost(p):
        x, y, z = p
        return (q00 * x * x + q11 * y * y + q22 * z * z + q33
                + 2 * (q01 * x * y + q02 * x * z + q12 * y * z + q03 * x + q13 * y + q23 * z))
    c0, c1, c2 = q11 * q22 - q12 * q12, q02 * q12 - q01 * q22, q01 * q12 - q02 * q11
    det = q00 * c0 + q01 * c1 + q02 * c2
    middle = tuple((a[k] + b[k]) / 2 for k in range(3))
    trace = q00 + q11 + q22
    if det > 1e-4 * trace ** 3:
        c11, c12, c22 = q00 * q22 - q02 * q02, q01 * q02 - q00 * q12, q00 * q11 - q01 * q01
        p = (-(c0 * q03 + c1 * q13 + c2 * q23) / det, -(c1 * q03 + c11 * q13 + c12 * q23) / det,
             -(c2 * q03 + c12 * q13 + c22 * q23) / det)
        reach = sum((a[k] - b[k]) ** 2 for k in range(3))
        if sum((p[k] - middle[k]) ** 2 for k in range(3)) < 4 * reach:
            return cost(p), p
    return min((cost(p), p) for p in (a, b, middle))


def face_normal(a, b, c):
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    wx, wy, wz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx


def slimness(corners, normal):
    """Square of the height over the longest side; 3/4 when all sides are alike."""
    longest = max(sum((corners[k][d] - corners[k - 1][d]) ** 2 for d in range(3)) for k in range(3))
    return sum(n * n for n in normal) / max(longest * longest, 1e-30)


class Collapser:
    """Edges by the error that their collapse brings, the least first."""

    def __init__(self, vertices, faces, labels, seam):
        self.q = quadrics(vertices, faces, labels, seam)
        self.v = [tuple(p) for p in vertices.tolist()]
        self.f = [tuple(f) for f in faces.tolist()]
        self.at = [set() for _ in self.v]  # faces around each vertex
        for i, f in enumerate(self.f):
            for k in f:
                self.at[k].add(i)
        self.version = [0] * len(self.v)
        self.left = len(self.f)
        self.heap = []

    def offer(self, i, j):
        q = [a + b for a, b in zip(self.q[i], self.q[j])]
        cost, p = best_point(q, self.v[i], self.v[j])
        heapq.heappush(self.heap, (cost, i, j, self.version[i], self.version[j], p))

    def around(self, i):
        return {k for f in self.at[i] for k in self.f[f]} - {i}

    def turns(self, i, j, p):
        """Whether a triangle around i that stays would turn over, or become more of a needle than it is."""
        for f in self.at[i]:
            face = self.f[f]
            if j in face:
                continue
            before = [self.v[k] for k in face]
            after = [p if k == i else self.v[k] for k in face]
            old, new = face_normal(*before), face_normal(*after)
            slim, slim_before = slimness(after, new), slimness(before, old)
            if slim < SLIM and slim < slim_before:
                return True
            dot = sum(a * b for a, b in zip(old, new))
            if slim_before > 0.001 and (dot <= 0 or dot * dot < 0.1 * sum(a * a for a in old) * sum(a * a for a in new)):
                return True
        return False

    def collapse(self, i, j, p):
        for f in list(self.at[j]):
            face = self.f[f]
            if i in face:
                for k in face:
                    self.at[k].discard(f)
                self.f[f] = None
                self.left -= 1
            else:
                self.f[f] = tuple(i if k == j else k for k in face)
                self.at[i].add(f)
        self.at[j] = set()
        self.q[i] = [a + b for a, b in zip(self.q[i], self.q[j])]
        self.v[i] = p
        self.version[i] += 1
        self.version[j] = -1
        for k in self.around(i):
            self.offer(min(i, k), max(i, k))

    def offer_all(self):
        self.heap = []
        for f in filter(None, self.f):
            for k in range(3):
                if f[k] < f[k - 1]:
                    self.offer(f[k], f[k - 1])

    def run(self, target):
        """Rounds, since an edge that could not go may be able to when others around it have gone."""
        before = None
        while self.left > target and self.left != before:
            before = self.left
            self.offer_all()
            while self.left > target and self.heap:
                _, i, j, vi, vj, p = heapq.heappop(self.heap)
                if self.version[i] != vi or self.version[j] != vj:
                    continue
                if len(self.around(i) & self.around(j)) != 2:  # it would pinch the surface (the link condition)
                    continue
                if not self.turns(i, j, p) and not self.turns(j, i, p):
                    self.collapse(i, j, p)


def decimate(vertices, faces, labels, target, seam=1.0):
    """The mesh with about `target` triangles."""
    work = Collapser(vertices, faces, labels, seam)
    work.run(target)
    kept = [i for i, f in enumerate(work.f) if f]
    used = sorted({k for i in kept for k in work.f[i]})
    number = {k: n for n, k in enumerate(used)}
    return (np.array([work.v[k] for k in used]), np.array([[number[k] for k in work.f[i]] for i in kept]),
            np.array(labels)[kept])


def check_closed(faces):
    """Every edge has two triangles, which run along it in opposite directions."""
    edges = set()
    for f in faces.tolist():
        for k in range(3):
            edge = (f[k], f[(k + 1) % 3])
            assert edge not in edges, "an edge runs twice in one direction"
            edges.add(edge)
    assert all((b, a) in edges for a, b in edges), "the mesh has a hole"


def build(shape, low, high, cell, target, materials=None):
    """The surface of `shape`; materials: {name: shape}, of which the least counts."""
    vertices, faces = contour(shape, low, high, cell)
    vertices = settle(shape, vertices, cell)
    names = list(materials or {"body": None})
    labels = np.zeros(len(faces), int)
    if materials:
        middle = vertices[faces].mean(axis=1)
        labels = np.argmin([materials[n](middle) for n in names], axis=0)
    vertices, faces, labels = decimate(vertices, faces, labels, target)
    check_closed(faces)
    return vertices, faces, [names[k] for k in labels]


def write_obj(folder, name, script, mesh, colors):
    """NAME.obj and NAME.mtl; colors: {material: (r, g, b)}, linear, or ((r, g, b), how much is mirrored,
    exponent of the highlight)."""
    vertices, faces, labels = mesh
    with open("%s/%s.mtl" % (folder, name), "w") as out:
        for key, color in colors.items():
            color, *shine = color if isinstance(color[0], tuple) else (color,)
            out.write("newmtl %s\nKd %g %g %g\n" % ((key,) + color))
            if shine:
                out.write("Ks %g %g %g\nNs %g\n" % ((shine[0],) * 3 + (shine[1],)))
    with open("%s/%s.obj" % (folder, name), "w") as out:
        out.write("# Made by scripts/data/%s. Z up, metres.\nmtllib %s.mtl\n" % (script, name))
        for v in vertices:
            out.write("v %.4f %.4f %.4f\n" % tuple(v))
        for key in colors:
            out.write("usemtl %s\n" % key)
            for f, label in zip(faces, labels):
                if label == key:
                    out.write("f %d %d %d\n" % tuple(f + 1))
    print("%s: %d vertices, %d triangles" % (name, len(vertices), len(faces)))
