"""Signed distances for the meshes that the scripts beside this file make: shapes, and what joins them.

A shape is a function: an array of N points (N x 3, metres) to N distances, negative inside. They
need not be exact distances, only near them close to the surface.
"""
import numpy as np


def norm(v):
    """Length of each row; by hand, which is several times faster than numpy.linalg for three."""
    return np.sqrt(v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1] + v[:, 2] * v[:, 2])


def limb(*joints):
    """A chain of cones with round ends: (x, y, z, radius) at each joint."""
    joints = np.array(joints, float)

    def distance(p):
        least = np.full(len(p), np.inf)
        for (a, b) in zip(joints, joints[1:]):
            along = b[:3] - a[:3]
            t = np.clip((p - a[:3]) @ along / max(along @ along, 1e-12), 0, 1)
            least = np.minimum(least, norm(p - a[:3] - t[:, None] * along) - (a[3] + (b[3] - a[3]) * t))
        return least
    return distance


def spline(joints, steps=6):
    """Points of a Catmull-Rom curve through the joints, for limb: smooth in place and radius."""
    j = np.array(joints, float)
    j = np.vstack((2 * j[0] - j[1], j, 2 * j[-1] - j[-2]))
    out = []
    for i in range(1, len(j) - 2):
        for t in np.arange(steps) / steps:
            a, b, c, d = j[i - 1:i + 3]
            out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3))
    return np.array(out + [j[-2]])


def turned(degrees, axis):
    """A rotation about one axis, by the right hand."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    m = np.eye(3)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    return m


def ellipsoid(center, radii, turn=None):
    """Quilez's bound: exact at the surface to first order."""
    center, radii = np.array(center, float), np.array(radii, float)

    def distance(p):
        q = p - center
        if turn is not None:
            q = q @ turn  # into its own axes: the inverse is the transpose, from the right
        k0, k1 = norm(q / radii), norm(q / (radii * radii))
        return np.where(k1 > 0, k0 * (k0 - 1) / np.maximum(k1, 1e-9), -radii.min())
    return distance


def brick(center, half, rounding=0.0, turn=None):
    """A box with round edges."""
    center, half = np.array(center, float), np.array(half, float) - rounding

    def distance(p):
        q = p - center
        if turn is not None:
            q = q @ turn
        q = np.abs(q) - half
        return norm(np.maximum(q, 0)) + np.minimum(q.max(axis=1), 0) - rounding
    return distance


def smooth_min(a, b, k):
    """The smaller, rounded where they differ by less than k (Quilez's quadratic)."""
    if k <= 0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k * 0.25


def join(k, *shapes):
    """All of them, with fillets of about k."""
    def distance(p):
        d = shapes[0](p)
        for s in shapes[1:]:
            d = smooth_min(d, s(p), k)
        return d
    return distance


def cut(k, shape, *tools):
    """The shape without the tools, with edges rounded by k."""
    def distance(p):
        d = shape(p)
        for s in tools:
            d = -smooth_min(-d, s(p), k)
        return d
    return distance


def common(k, *shapes):
    """What is in all of them."""
    def distance(p):
        d = shapes[0](p)
        for s in shapes[1:]:
            d = -smooth_min(-d, -s(p), k)
        return d
    return distance


def mirrored(shape):
    """Both halves of what is symmetric about y = 0, from the one at y > 0."""
    return lambda p: shape(np.column_stack((p[:, 0], np.abs(p[:, 1]), p[:, 2])))


def near(shape, center, radius):
    """The same shape, which a ball of that radius holds, asked only near it: what is far costs nothing."""
    center = np.array(center, float)

    def distance(p):
        d = norm(p - center) - radius
        close = d < radius
        if close.any():
            d[close] = shape(p[close])
        return d
    return distance


def loft(keys, power):
    """Along X a cross-section that changes: (x, half width, lowest z, highest z), a superellipse."""
    x, width, low, high = spline(keys, 8).T

    def distance(p):
        w, a, b = (np.interp(p[:, 0], x, v) for v in (width, low, high))
        h = (b - a) / 2
        y, z = np.abs(p[:, 1]) / w, np.abs(p[:, 2] - (a + b) / 2) / h
        side = ((y ** power + z ** power) ** (1 / power) - 1) * np.minimum(w, h)
        return np.maximum(side, np.maximum(x[0] - p[:, 0], p[:, 0] - x[-1]))
    return distance
