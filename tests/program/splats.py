"""Particles drawn by the program: a flipbook from a file, a curve over age, a density of them; mistakes are named."""
from lib.pictures import Png, write_png
from lib.program import Case, main

HEAD = """
local fx = effect { name = "splats", fps = 10, frames = 20 }
fx.camera = camera { eye = {0, -5, 0}, target = {0, 0, 0}, fov = 20 }
local one = particles { count = 4, burst = 1, lifetime = 1.05, time_step = 0.05 }
"""
DRAWN = HEAD + """
local drawn = splats { one, size = over_age { {0, 1}, {0.45, 1}, {0.55, 0.2}, {1, 0.2} },
                       sprite = image "cells.png", flipbook = {2, 1}, blend = "sorted", lit = false }
fx.output = drawn.image
return fx
"""


class Splats(Case):
    def setUp(self):
        super().setUp()
        write_png(self.path("cells.png"), 16, 8, lambda x, y: (255, 0, 0) if x < 8 else (0, 255, 0))

    def frame(self, number, *settings):
        """The middle of a frame, and how much of it is covered."""
        self.write("effect.lua", DRAWN)
        self.succeeds("render", "effect.lua", "--frames", str(number), "--size", "64x64", "--alpha", "-o", "o.png",
                      *(word for text in settings for word in ("--set", text)))
        picture = Png(self.read("o.png"))
        return picture.rows[32][4 * 32:4 * 32 + 3], sum(alpha > 0 for alpha in picture.channel(3))

    def test_a_flipbook_and_a_size_go_with_age(self):
        color, young = self.frame(3)
        self.assertGreater(color[0], 200)
        self.assertEqual(color[1:], (0, 0))
        color, old = self.frame(9)
        self.assertEqual((color[0], color[2]), (0, 0))
        self.assertGreater(color[1], 200)
        self.assertGreater(young, 8 * old)
        _, gone = self.frame(12)
        self.assertEqual(gone, 0)

    def test_a_number_over_age_is_edited_as_a_curve(self):
        _, old = self.frame(9)
        listed = self.succeeds("info", "params", "effect.lua")
        self.assertIn("a number over a particle's life (0..1)", listed)
        self.assertNotIn("palette", listed.replace("palettes and curves", ""))
        self.assertEqual(self.frame(9, "drawn_size=linear 0 1; 0.45 1; 0.55 0.2; 1 0.2")[1], old)
        _, larger = self.frame(9, "drawn_size=linear 0 0.2; 1 0.6")
        self.assertGreater(larger, 2 * old)
        for text, says in (("cubic 0 1; 1 2", "linear"), ("linear 0 1; 0 2", "does not come after"), ("linear 0 1,1,1; 1 2,2,2", "component"),
                           ("linear 0 1; 1 -2", "65504"), ("linear 0 1", "2")):
            with self.subTest(text):
                self.fails(1, ["drawn_size", says], "render", "effect.lua", "--set", "drawn_size=" + text, "-o", "o.png")

    def test_particles_are_a_density(self):
        self.write("effect.lua", HEAD + """
local dust = deposit { one, box = { min = {-1, -1, -1}, max = {1, 1, 1} }, resolution = 8, size = 1, amount = 4 }
fx.output = march { density = dust.density, albedo = 0 }.color
return fx
""")
        self.succeeds("render", "effect.lua", "--frames", "3", "--size", "32x32", "--alpha", "-o", "o.png")
        self.assertGreater(max(Png(self.read("o.png")).channel(3)), 200)

    def test_mistakes_are_named(self):
        for call, says in (
                ("splats { size = 1 }", "'particles' is missing"),
                ("splats { one, sprite = 'cells.png' }", "input 'sprite' takes an image"),
                ("splats { one, blend = 'sort' }", "cannot be 'sort'; accepted: additive, weighted, sorted"),
                ("splats { one, blend = true }", "'on'"),
                ("deposit { one }", "'box' is missing or flat"),
                ("deposit { one, box = { min = {0, 0, 0}, max = {1, 1, 1} }, resolution = 1000 }", "4 to 512 cells"),
                ("over_age { {0, 1}, {1, {1, 0, 0}} }", "no value like the first"),
                ("splats { particles { count = 4e6, burst = 1 }, blend = 'sorted' }", "too many to be sorted")):
            with self.subTest(call):
                self.refuses(HEAD + call + "\nreturn fx", says)


main()
