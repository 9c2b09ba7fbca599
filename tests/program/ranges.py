"""What the shipped effects' densities can be in a box: no value lies outside, and empty space is
found to be empty."""
import os
import re
import shutil

from lib.pictures import Png
from lib.program import DATA, SOURCE, Case, main

# Where the volume is, and the least part of the boxes without density that must be found.
EFFECTS = {
    "explosion": ("{-1, -1, -1}", "{9, 9, 8}", 0.7),
    "plume": ("{-4, -6, 4}", "{16, 8, 22}", 0.7),
    "plumes": ("{-5, -3, -1}", "{5, 3, 8}", 0.5),
    "cloud": ("{-900, -900, 0}", "{900, 900, 1200}", 0.7),
    "tile": ("{-7, -7, -7}", "{7, 7, 7}", 0.5),
    "paper": ("{-1, -1, -1}", "{9, 9, 8}", 0.7),
}
# Everything else that a grid can be: blended, in bricks, repeating.
GRIDS = """
local fx = effect { name = "grids" }
local burst = vdb { "data/explosion-32/*.vdb", fps = 10, blend = true, storage = "%s" }
local speckle = tile(perlin { frequency = 1, octaves = 2, period = 4 }, { resolution = 16, cells = 4 })
local density = (burst.density + 0.2 * burst.flame) * clamp(speckle * 3 - 1, 0, 1)
"""
TILE = """
local fx = effect { name = "tile" }
local speckle = tile(perlin { frequency = 0.5, octaves = 2 }, { resolution = 64, cells = 4 })
local density = clamp(speckle * 5 - 2.6, 0, 1)
"""
PASS = """
fx.output = shader { "ranges.comp", density = %s, low = %s, high = %s }.color
return fx
"""


class Ranges(Case):
    def setUp(self):
        super().setUp()
        shutil.copytree(os.path.join(SOURCE, "effects", "data"), self.path("data"))
        shutil.copy(os.path.join(DATA, "ranges.comp"), self.path("ranges.comp"))

    def try_ranges(self, name, density, sampling):
        with open(os.path.join(SOURCE, "effects", name + ".lua"), encoding="utf-8") as f:
            text = f.read()
        end = re.search(r"^local (lit|scene)\b", text, re.M).start()  # fields come first
        self.hold(name, text[:end], density, sampling)

    def hold(self, name, text, density, sampling, width=0, least=None):
        low, high, part = EFFECTS[name]
        options = f', sampling = "{sampling}", width = {width}'
        self.write("effect.lua", text + PASS % (density, low, high + options))
        self.succeeds("render", "effect.lua", "--frames", "20", "--size", "64x64", "-o", "o.png")
        picture = Png(self.read("o.png"))
        pixels = [row[i:i + 3] for row in picture.rows for i in range(0, len(row), picture.channels)]
        self.assertEqual(sum(p[0] > 0 for p in pixels), 0, f"{name}: values lie outside")
        empty = [p for p in pixels if p[2] > 0]
        found = [p for p in empty if p[1] > 0]
        self.assertGreater(len(pixels) - len(empty), 100)
        self.assertGreater(len(found) / len(empty), part if least is None else least, name)

    def test_torn_grid_and_warped_noise(self):
        self.try_ranges("explosion", "cover * crust * (smoke + 0.15) * density", "linear")

    def test_warped_bake(self):
        self.try_ranges("plume", "whole:warp(eddies, ragged) * density", "quasi_cubic")

    def test_advected_noise_itself(self):
        self.try_ranges("plume", "smoke * density", "linear")

    def test_sum_and_shapes(self):
        self.try_ranges("plumes", "smoke * density + 0.5 * bulbs", "cubic")

    def test_noise_on_a_grid(self):
        self.try_ranges("cloud", "body * eaten * density", "quasi_cubic")

    def test_blended_grid(self):
        self.hold("explosion", GRIDS % "dense", "density", "cubic")

    def test_grid_in_bricks(self):
        self.hold("explosion", GRIDS % "sparse", "density", "quasi_cubic")
        self.hold("explosion", GRIDS % "sparse", "density", "cubic")

    def test_tile_and_its_levels(self):
        self.hold("tile", TILE, "density", "linear")
        self.hold("tile", TILE, "density", "linear", width=0.1, least=0.1)
        self.hold("tile", TILE, "density", "linear", width=0.5, least=-1)  # too wide to know much

    def test_transformed_noise(self):
        self.try_ranges("paper", "density", "quasi_cubic")


if __name__ == "__main__":
    main()
