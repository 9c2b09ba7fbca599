"""Presets and recipes: what was turned once is found again, in files and in pictures."""
import os

from lib.pictures import Png
from lib.program import Case, main

EFFECT = """local fx = effect { name = "puff", frames = 9 }
local density = param { "density", 4, min = 0, max = 100, unit = "1/m", help = "of the smoke" }
local tint = param { "tint", "#ffffff" }
local look = param { "look", "flat", words = { "flat", "lumpy" } }
local fire = palette { {0, "#000000"}, {1, "#ff8000"} }
local fade = curve { {0, 1}, {1, 2} }
local body = sphere { radius = 1, falloff = 0.4 }
if look:get() == "lumpy" then body = body * perlin { frequency = 3 } end
fx.camera = orbit { target = {0, 0, 0}, distance = 4 }
local g = geometry { }
local m = march { density = body * density * fade, emission = fire(body).rgb * tint, depth = g.depth, steps = 24 }
fx.output = final { over { volume = m.color, edge = m.edge, source = shade { from = g }, depth = g.depth } }
"""
SETTINGS = {
    "density": "9", "tint": "1,0.5,2", "look": "lumpy", "fire": "0 #000000; 0.5 0,3,0 0.5; 1 #ffffff",
    "fade": "cubic 0 2; 1 1", "camera.eye": "1,-3,1", "camera.fov": "50", "sun.elevation": "10",
    "march.steps": "31", "march.resolution": "0.5", "march.albedo": "0.9,0.2,0.1",
}
PRESET = """return {
  density = 9, tint = {1, 0.5, 2}, look = "lumpy", fire = { {0, "#000000"}, {0.5, {0, 3, 0}, 0.5}, {1, "#ffffff"} },
  fade = { {0, 2}, {1, 1}, shape = "cubic" }, ["camera.eye"] = {1, -3, 1}, ["camera.fov"] = 50,
  ["sun.elevation"] = 10, ["march.steps"] = 31, ["march.resolution"] = 0.5, ["march.albedo"] = {0.9, 0.2, 0.1},
}
"""


class Presets(Case):
    def setUp(self):
        super().setUp()
        self.write("fx/puff.lua", EFFECT)

    def render(self, *args):
        """The pixels that these arguments give."""
        self.succeeds("render", *args, "-o", "out.png")
        return Png(self.read("out.png")).rows

    def moved(self):
        return [arg for name, value in SETTINGS.items() for arg in ("--set", f"{name}={value}")]

    def test_picture_is_repeated(self):
        self.succeeds("render", "fx/puff.lua", "-f", "5", "-s", "48x32", "-o", "shot.png", *self.moved())
        shot = Png(self.read("shot.png")).rows
        self.assertNotEqual(shot, self.render("fx/puff.lua", "-f", "5", "-s", "48x32"))
        self.assertEqual(shot, self.render("--from", "shot.png"))
        self.assertEqual(shot, self.render("--from", "out.png"))  # a repeated one is as good
        self.assertEqual(shot, self.render("fx/puff.lua", "--from", "shot.png"))
        self.assertNotEqual(shot, self.render("--from", "shot.png", "--set", "density=1"))
        self.assertNotEqual(shot, self.render("--from", "shot.png", "--frames", "1"))
        self.render("--from", "shot.png", "--size", "20x10")
        self.assertEqual(Png(self.read("out.png")).width, 20)

    def test_effect_outside_is_named_by_the_user(self):
        effect = self.path("fx/puff.lua")
        shot = self.render(effect, "-f", "2", "-s", "16x16")
        os.replace(self.path("out.png"), os.path.join(self.folder, "shot.png"))
        self.fails(1, ["shot.png: its effect lies outside", "name it"], "render", "--from", "shot.png")
        self.assertEqual(shot, self.render(effect, "--from", "shot.png"))

    def test_pictures_without_a_recipe(self):
        self.write("bad.png", "no picture")
        self.fails(1, "bad.png: is not a PNG file", "render", "--from", "bad.png")
        self.fails(1, "none.png", "render", "--from", "none.png")
        self.succeeds("render", "fx/puff.lua", "-f", "1", "-s", "16x16", "-o", "shot.png")
        data = self.read("shot.png")
        at = data.index(b"tEXtroil:effect") - 4
        length = int.from_bytes(data[at:at + 4], "big")
        with open(self.path("plain.png"), "wb") as f:
            f.write(data[:at] + data[at + 12 + length:])
        self.fails(1, "plain.png: the picture has no recipe", "render", "--from", "plain.png")

    def test_preset_is_what_its_settings_are(self):
        self.write("fx/puff.presets/warm.lua", PRESET)
        self.write("mine.lua", PRESET)
        size = ["-f", "5", "-s", "48x32"]
        wanted = self.render("fx/puff.lua", *size, *self.moved())
        self.assertEqual(wanted, self.render("fx/puff.lua", *size, "--preset", "warm"))
        self.assertEqual(wanted, self.render("fx/puff.lua", *size, "--preset", "mine.lua"))
        self.assertEqual(wanted, self.render("--from", "out.png"))

    def test_later_values_win(self):
        self.write("fx/puff.presets/thin.lua", "return { density = 1, look = 'lumpy' }")
        self.write("fx/puff.presets/thick.lua", "return { density = 50 }")
        text = self.succeeds("info", "params", "fx/puff.lua", "--preset", "thin", "--preset", "thick")
        self.assertRegex(text, r"density = 50 .*of the smoke \(moved; the script says 4\)")
        self.assertIn("look = flat | lumpy*", text)
        text = self.succeeds("info", "params", "fx/puff.lua", "--set", "density=7", "--preset", "thick")
        self.assertIn("density = 7 ", text)
        self.assertIn("fx/puff.lua: good", self.succeeds("check", "fx/puff.lua", "--preset", "thin"))

    def test_bad_presets(self):
        self.write("fx/puff.presets/warm.lua", "return { density = 1 }")
        self.write("fx/puff.presets/wrong.lua", "return { densty = 1 }")
        self.write("fx/puff.presets/broken.lua", "return {")
        for command in (["render"], ["check"], ["info", "params"]):
            run = [*command, "fx/puff.lua", "--preset"]
            self.fails(1, ["has no preset 'wram'", "did you mean 'warm'?"], *run, "wram")
            self.fails(1, "has no preset 'cold'; it has broken, warm, wrong\n", *run, "cold")
            self.fails(1, "did you mean 'density'?", *run, "wrong")
            self.fails(1, "broken.lua:1:", *run, "broken")
            self.fails(1, "is not a name", *run, "../warm")
        self.write("plain.lua", EFFECT)
        self.fails(1, "plain.lua has no presets, so no 'cold'", "check", "plain.lua", "--preset", "cold")

    def test_info_says_what_there_is(self):
        text = self.succeeds("info", "params", "fx/puff.lua", "--set", "march.steps=31")
        self.assertRegex(text, r"look = flat\* \| lumpy +\(structure: read while the effect loads\)")
        self.assertRegex(text, r"fire = 0 #000000; 1 #ff8000")
        self.assertRegex(text, r"camera\.\*\n  eye = ")
        self.assertRegex(text, r"steps = 31 \[1, 4096\][^(]*\(moved; the script says\s+24\)")


if __name__ == "__main__":
    main()
