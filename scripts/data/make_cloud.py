"""Grow a cumulus and write it as one OpenVDB file with a fog volume `density`, 0 to 1.

  /usr/bin/python3 scripts/data/make_cloud.py effects/data/cloud.vdb

Debian: apt-get install python3-openvdb python3-numpy (OpenVDB's module is for Debian's own Python).

A cumulus is a heap of bubbles of air, each covered with smaller ones. So is this: spheres that
carry smaller spheres on their upper sides, four generations of them; the largest distance into any
sphere is the depth below the surface. It is pushed in and out by cellular noise, which is round
outside and creased inside as the cloud is; a plane that is not quite flat cuts it off where the
rising air reaches its dew point. Water condenses on the way up: density grows with height.

Everything is seeded: the same versions of NumPy and OpenVDB write the same bytes.
"""
import math
import sys

import numpy as np
import pyopenvdb as vdb

VOXEL = 8.0                 # metres
SIZE = (160, 140, 106)      # voxels
ORIGIN = (-640.0, -560.0, 0.0)
BASE = 55.0                 # metres, of the condensation level
EDGE = 24.0                 # metres from the surface to where the density is whole
STEPS = 128                 # of the density: few values pack well
CHILDREN = (16, 12, 9)      # spheres on each sphere, by generation
UUID = b"6a3bd2c0-8f5e-4c1f-9d27-000000000001"  # instead of a random one

# The bubbles that the others grow on: x, y, height above the base, radius, in metres.
CORE = (
    (30, 0, 150, 235), (60, 10, 350, 215), (20, -30, 520, 165), (115, 30, 560, 130), (45, 0, 640, 95),
    (-225, 40, 130, 190), (-245, 10, 300, 150), (-210, -10, 410, 95),
    (275, -50, 110, 180), (300, -30, 250, 125), (-90, -230, 90, 165), (-70, -200, 220, 115),
    (130, 220, 100, 165), (110, 200, 240, 120), (-420, 40, 60, 120), (445, 10, 50, 110),
    (-290, -200, 50, 110), (320, 200, 50, 110), (170, -260, 40, 110),
)

rng = np.random.RandomState(11)


def cover(parent, generation, out):
    """Adds a sphere and, on its sides and top, smaller ones."""
    x, y, z, radius = parent
    out.append(parent)
    if generation == len(CHILDREN) or radius < 2.5 * VOXEL:
        return
    count = CHILDREN[generation]
    turn = rng.uniform(0, 2 * math.pi)
    for i in range(count):
        up = -0.35 + 1.3 * (i + rng.uniform(0.2, 0.8)) / count    # never below the belly
        up = min(up, 0.98)
        around = turn + i * 2.39996 + rng.uniform(-0.3, 0.3)      # the golden angle
        flat = math.sqrt(1 - up * up)
        size = radius * rng.uniform(0.3, 0.52)
        reach = radius * rng.uniform(0.8, 0.98)
        cover((x + reach * flat * math.cos(around), y + reach * flat * math.sin(around),
               z + reach * up, size), generation + 1, out)


def axes():
    return [ORIGIN[i] + (np.arange(SIZE[i], dtype=np.float32) + 0.5) * np.float32(VOXEL)
            for i in range(3)]


def depth_below(spheres):
    """Metres below the surface of the union; negative outside."""
    depth = np.full(SIZE, -1e3, np.float32)
    centres = axes()
    for sphere in spheres:
        radius, near = sphere[3], []
        for i in range(3):
            reach = radius + 60
            near.append(slice(*np.searchsorted(centres[i], (sphere[i] - reach, sphere[i] + reach))))
        x, y, z = (centres[i][near[i]] - np.float32(sphere[i]) for i in range(3))
        distance = np.sqrt(x[:, None, None]**2 + y[None, :, None]**2 + z[None, None, :]**2)
        block = depth[tuple(near)]
        np.maximum(block, radius - distance, out=block)
    return depth


def cells(points, size, seed):
    """Worley's noise: 1 at feature points, falling to 0 a cell away."""
    at = points / size
    cell = np.floor(at).astype(np.int64)
    nearest = np.full(len(points), 1.0)
    for k in range(27):
        c = cell + np.array((k % 3 - 1, k // 3 % 3 - 1, k // 9 - 1))
        h = (c * (73856093, 19349663, 83492791)).sum(axis=1) + seed * 2654435761
        feature = np.empty_like(at)
        for i in range(3):
            h = (h ^ (h >> 13)) * 1274126177 & 0xffffffff
            feature[:, i] = (h >> 8 & 0xffff) / 65536.0
        np.minimum(nearest, ((c + feature - at)**2).sum(axis=1), out=nearest)
    return 1 - np.sqrt(nearest)


def smooth(values, low, high):
    t = np.clip((values - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def grow():
    spheres = []
    for x, y, z, radius in CORE:
        cover((x, y, z + BASE, radius), 0, spheres)
    depth = depth_below(spheres)
    shell = np.abs(depth) < 60                       # all that the noise can move
    points = np.argwhere(shell) * VOXEL
    bumps = 34 * cells(points, 95.0, 1) + 18 * cells(points, 47.0, 2) - 26
    depth[shell] += bumps
    x, y, z = np.meshgrid(*axes(), indexing="ij", sparse=True)
    level = BASE + 9 * np.sin(x / 83 + 1) * np.sin(y / 71 + 2) + 5 * np.sin(x / 31) * np.sin(y / 37)
    above = z - level
    density = smooth(depth, 0, EDGE) * smooth(above, 0, 45)
    density *= 0.55 + 0.45 * np.clip(above / 450, 0, 1)
    return np.round(density * STEPS) / STEPS


def write(density, path):
    grid = vdb.FloatGrid()
    grid.name = "density"
    grid.gridClass = vdb.GridClass.FOG_VOLUME
    grid.saveFloatAsHalf = True
    centre = [ORIGIN[i] + VOXEL / 2 for i in range(3)]
    grid.transform = vdb.createLinearTransform(
        [[VOXEL, 0, 0, 0], [0, VOXEL, 0, 0], [0, 0, VOXEL, 0], centre + [1]])
    accessor = grid.getAccessor()
    for ijk in np.argwhere(density > 0).tolist():
        accessor.setValueOn(tuple(ijk), float(density[tuple(ijk)]))
    grid.prune()
    vdb.write(path, grids=[grid])
    with open(path, "r+b") as file:                  # it follows magic, versions and a flag
        file.seek(21)
        old = file.read(36)
        if old[8:9] + old[13:14] != b"--":
            sys.exit("no UUID where one was expected in %s" % path)
        file.seek(21)
        file.write(UUID)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    cloud = grow()
    write(cloud, sys.argv[1])
    print("%d of %d voxels" % ((cloud > 0).sum(), cloud.size))
