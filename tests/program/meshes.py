"""The meshes that smoke meets or comes from are closed, as the voxels of a body need them to be. What is
seen of them instead lies on them."""
import itertools
import math
import os
import unittest

DATA = os.path.join(os.environ["ROIL_SOURCE_DIR"], "effects", "data")
BODIES = ("figure", "creature", "creature_jaw", "creature_throat")

HIDES = {"creature_hide": "creature", "creature_jaw_hide": "creature_jaw"}  # what is seen, and what air meets


def read(name):
    vertices, faces = [], []
    with open(os.path.join(DATA, name + ".obj"), encoding="ascii") as file:
        for line in file:
            if line.startswith("v "):
                vertices.append(tuple(float(x) for x in line.split()[1:]))
            elif line.startswith("f "):
                faces.append(tuple(int(x) - 1 for x in line.split()[1:]))
    return vertices, faces


class Meshes(unittest.TestCase):
    def test_every_edge_has_two_triangles_that_agree(self):
        for name in BODIES:
            _, faces = read(name)
            edges = [(f[k - 1], f[k]) for f in faces for k in range(3)]
            with self.subTest(name):
                self.assertEqual(len(edges), len(set(edges)), "an edge runs twice in one direction")
                self.assertEqual({(b, a) for a, b in edges}, set(edges), "an edge has one triangle")

    def test_normals_look_outwards(self):
        for name in BODIES:
            v, faces = read(name)
            volume = sum(v[a][0] * (v[b][1] * v[c][2] - v[b][2] * v[c][1])
                         - v[a][1] * (v[b][0] * v[c][2] - v[b][2] * v[c][0])
                         + v[a][2] * (v[b][0] * v[c][1] - v[b][1] * v[c][0]) for a, b, c in faces) / 6
            with self.subTest(name):
                self.assertGreater(volume, 0)

    def test_they_are_small_enough_to_voxelise_while_they_move(self):
        for name in BODIES:
            with self.subTest(name):
                self.assertLessEqual(len(read(name)[1]), 20000)

    def test_the_hides_are_small_enough_for_rays_on_any_device(self):
        self.assertLess(sum(len(read(name)[1]) for name in HIDES), 40000)

    def test_a_hide_lies_on_its_body(self):
        cell = 0.1  # metres: more than the crest or a scale stands off
        for name, body in HIDES.items():
            solid = set()
            for p in read(body)[0]:
                at = [math.floor(x / cell) for x in p]
                solid.update(itertools.product(*((k - 1, k, k + 1) for k in at)))
            off = [p for p in read(name)[0] if tuple(math.floor(x / cell) for x in p) not in solid]
            with self.subTest(name):
                self.assertEqual(off, [])


if __name__ == "__main__":
    unittest.main()
