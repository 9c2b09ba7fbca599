"""The account of memory: what a file asks for beyond --memory is refused before it is taken, with the
sum and its three largest parts."""
import os
import re
import resource
import unittest

from lib.pictures import exr_header
from lib.program import SMALL, VOLUME, Case, main

HEAD = 'local fx = effect { name = "greedy" }\n'
BALL = "sphere { radius = 1 }"
LIMIT = 256  # MiB, of what is refused here; each asks for several times as much
REFUSAL = re.compile(r"([\d.]+) MiB of (?:device )?memory would be taken in all, and ([\d.]+) MiB may be, of [\d.]+ MiB "
                     r"\(--memory 80% or --memory 8G, .*\); the largest parts: (.*)")
PART = re.compile(r"(.+?) ([\d.]+) MiB(?:, |$)")


class Memory(Case):
    def refusal(self, *args, limit=LIMIT):
        """The sum and the labels of the largest parts, of a run that took no more than its limit."""
        message = self.fails(1, "--memory", *args, "--memory", f"{limit}M")
        self.assertFalse(os.path.exists(self.path("out.png")))
        found = REFUSAL.search(message)
        self.assertIsNotNone(found, message)
        total, most = float(found[1]), float(found[2])
        self.assertEqual(most, limit)
        self.assertGreater(total, limit)
        parts = [(label, float(size)) for label, size in PART.findall(found[3])]
        self.assertLessEqual(len(parts), 3)
        self.assertEqual([size for _, size in parts], sorted((size for _, size in parts), reverse=True))
        return total, [label for label, _ in parts]

    def draw(self, effect, *args, limit=LIMIT):
        self.write("effect.lua", effect)
        return self.refusal("render", "effect.lua", "--frames", "1", "-o", "out.png", *args, limit=limit)

    def empty(self, name, mebibytes):
        with open(self.path(name), "wb") as f:
            f.truncate(mebibytes << 20)

    def test_grids_on_sparse_files(self):
        marches = []
        for i in range(3):  # a pass samples at most 32 images
            grids = []
            for k in range(12):
                name = f"a{12 * i + k}.raw"
                self.empty(name, 64)
                grids.append('raw { "%s", type = "u8", size = {256, 256, 256} }.density' % name)
            marches.append('march { name = "m%d", density = %s }' % (i, " + ".join(grids)))
        effect = HEAD + "fx.output = final { over { %s, over { %s, %s.color }.color } }.color\nreturn fx\n" % tuple(marches)
        total, labels = self.draw(effect, *SMALL)
        self.assertGreater(total, 36 * 32)  # halves of all grids, before the first is read
        self.assertEqual(labels[0], "ranges")  # of all of them together
        self.assertTrue(all(re.fullmatch(r"a\d+\.raw", label) for label in labels[1:]), labels)

    def test_picture_of_full_size(self):
        effect = HEAD + f"fx.output = march {{ density = {BALL} }}.color\nreturn fx\n"
        total, labels = self.draw(effect, "--size", "16384x16384")
        self.assertGreater(total, 4096)  # of all images of the pass, before the first is made
        self.assertEqual(labels[0], "march.color")
        self.assertIn("march.edge", labels)

    def test_lattice_and_pictures(self):
        """Each of them would fit by itself; what all passes and pictures take is known before any of it is made."""
        effect = HEAD + ("local air = lbm { size = {128, 128, 128}, voxel_size = 0.02, speed = 2 }\n"
                         "air:source { shape = sphere { radius = 0.3 }, density = 1 }\n"
                         "fx.output = march { density = air.density }.color\nreturn fx\n")
        total, labels = self.draw(effect, "--size", "3840x2160")
        self.assertEqual(labels, ["lattice", "lattice's moments", "march.color"])
        self.assertGreater(total, 76 + 64 + 16 + 2 * 63)  # the state, its moments, the grid, two of the pictures

    def test_declarations(self):
        self.write("effect.lua", HEAD + "local t = {}\nfor i = 1, 1e7 do t[i] = perlin { frequency = i } end\n")
        message = self.fails(1, ["effect.lua:3:", "--memory", "the script and what it declares"],
                             "check", "effect.lua", "--memory", "64M")
        self.assertRegex(message, REFUSAL)

    def test_declarations_keep_to_the_limit_of_a_script(self):
        """What is declared takes no more of the process than its limit says, by far."""
        self.write("effect.lua", HEAD + "local t = {}\nfor i = 1, 1e7 do t[i] = perlin { frequency = i } end\n")
        self.fails(1, "memory limit of 256 MiB exceeded", "check", "effect.lua")
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # KiB, of all tests of this file
        self.assertLess(most, 900 << 10)

    def test_particles(self):
        effect = HEAD + ("local p = particles { count = 1 << 22, rate = 1000, lifetime = 1 }\n"
                         "fx.output = final { splats { from = p } }.color\nreturn fx\n")
        self.draw(effect, *SMALL, limit=64)

    def test_sequence(self):
        """Frames ahead of time are fewer where there is less memory; the one that is shown must fit."""
        self.empty("long.raw", 100 * 64)
        effect = VOLUME % 'raw { "long.raw", type = "u8", size = {256, 256, 256}, frames = 100 }.density'
        total, labels = self.draw(effect, *SMALL, limit=64)
        self.assertIn("long.raw", labels)
        self.write("effect.lua", effect)
        self.succeeds("render", "effect.lua", "--frames", "1-3", "-o", "out%d.png", *SMALL, "--memory", "400M")

    def test_small_effect_within_a_small_limit(self):
        self.render(VOLUME % BALL, "--memory", "64M")

    def test_pictures_compared(self):
        """By what the headers say: neither has any pixels."""
        self.write("large.exr", exr_header(8000, 8000, "RGB"))
        self.write("other.exr", exr_header(8000, 7000, "RGB"))
        total, labels = self.refusal("compare", "large.exr", "other.exr")
        self.assertGreater(total, (8000 + 7000) * 8000 * 12 / (1 << 20))
        self.assertEqual(labels, ["pictures read and compared", "large.exr", "other.exr"])

    def test_bad_limits(self):
        self.write("effect.lua", VOLUME % BALL)
        for text in ("80", "0%", "101%", "-1G", "8X", "much", ""):
            with self.subTest(text):
                self.fails(2, ["memory '%s'" % text, "accepted: a share"], "render", "effect.lua", "--frames", "1",
                           "-o", "out.png", f"--memory={text}")
        self.fails(1, "accepted: a share", "check", "effect.lua", "--memory", "80")


if __name__ == "__main__":
    main()
