"""Lengths that do not fit together: the picture does not say why it is black, the program does."""
import glob
import os

from lib.program import SMALL, SOURCE, Case, main

HEAD = 'local fx = effect { name = "hint", frames = 2 }\n'
VOLUME = HEAD + """fx.camera = orbit { target = {0, 0, 0}, distance = %g }
local cloud = march { density = %s, steps = 8, shadow_steps = 2 }
"""
BARE = VOLUME + "fx.output = final { cloud }.color\nreturn fx\n"
SKY = VOLUME + "fx.output = final { over { cloud, shade { from = geometry { } } } }.color\nreturn fx\n"
MESH = HEAD + """fx.camera = orbit { target = {0, 0, 0}, distance = 4, near = 0.5, far = 50 }
local meshes = { mesh { "ground.obj", position = {0, 0, -2} %s } }
meshes[#meshes + 1] = mesh { "box.obj" %s }
fx.output = final { shade { from = geometry { table.unpack(meshes) } } }.color
return fx
"""
BOX = "".join("v %d %d %d\n" % (x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) \
    + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n"


class Hints(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", BOX)

    def told(self, text, *parts):
        """Exactly one warning for each part, which names the effect and holds all its words."""
        self.write("hint.lua", text)
        done = self.run_program("check", "hint.lua")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [line for line in done.stderr.splitlines() if line]
        self.assertEqual(len(lines), len(parts), done.stderr)
        for line, words in zip(lines, parts):
            self.assertTrue(line.startswith("warning: hint.lua: "), line)
            for word in words:
                self.assertIn(word, line)

    def test_volume_far_larger_than_the_camera_is_away(self):
        ball = "sphere { radius = %g } * 0.01"
        self.told(SKY % (5, ball % 210),
                  ["'march' is 420 m long", "only 5 m away from its target", "lengths are metres"])
        self.told(SKY % (15, ball % 210))  # the camera may well be in a cloud

    def test_scene_far_smaller_than_the_camera_is_away(self):
        self.told(SKY % (500, "sphere { radius = 2 }"), ["'march' is only 4 m long", "500 m away"])
        self.told(SKY % (300, "sphere { radius = 2 }"))

    def test_mesh_in_other_units(self):
        self.told(MESH % ("", ", scale = 100"), ["'box.obj' is 200 m long", "lengths are metres"])
        self.told(MESH % ("", ", scale = 0.01"), ["'box.obj' is only 0.02 m long"])
        self.told(MESH % (", scale = 1000", ""))  # a ground may be large

    def test_meshes_that_the_camera_cannot_see(self):
        away = ", position = {0, 500, 0}, scale = 1"
        self.told(MESH % (away, away), ["at least", "'far' is 50 m", "none is seen"])
        self.told(MESH % ("", away))  # one is seen
        near = ", position = {0, -3.9, 0.7}, scale = 0.05"
        self.told(MESH % (near + " * 0.1", near), ["'near' is 0.5 m", "none is seen"])

    def test_dense_and_large_volume(self):
        ball = "sphere { radius = 210, falloff = 60 } * "
        self.told(SKY % (900, ball + "0.6"), ["march: 'density' comes to 0.6 per metre",
                                              "420 m across", "no farther than 5 m", "0.04 times"])
        self.told(SKY % (900, ball + "0.3"))

    def test_dense_grid_that_is_not_read_yet(self):
        self.write("cloud.raw", bytes(64))
        grid = ("raw { 'cloud.raw', size = {4, 4, 4}, type = 'u8', "
                "box = {min = {-210, -210, -210}, max = {210, 210, 210}} }.density * 0.6")
        self.told(SKY % (900, grid), ["'density' comes to 0.6 per metre", "420 m across"])

    def test_no_sky_behind_a_landscape(self):
        thin = "sphere { radius = %g } * 0.01"
        self.told(BARE % (300, thin % 60), ["'march' is 120 m long", "nothing draws a sky", "fx.sky"])
        self.told(BARE % (300, thin % 45))  # a small one may stand before nothing
        self.told(SKY % (300, thin % 60))

    def test_nothing_is_said_where_more_may_be_drawn(self):
        sparks = "local p = particles { rate = 10 }\nfx.output = final { over { cloud, splats { p } } }.color\n"
        self.told(VOLUME % (5, "sphere { radius = 210 } * 0.01") + sparks + "return fx\n")

    def test_rendering_tells_once(self):
        self.write("hint.lua", BARE % (300, "sphere { radius = 60 } * 0.01"))
        done = self.run_program("render", "hint.lua", "--frames", "0-1", "-o", "%02d.png", *SMALL)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("nothing draws a sky"), 1, done.stderr)

    def test_shipped_effects_are_silent(self):
        effects = sorted(glob.glob(os.path.join(SOURCE, "effects/*.lua")))
        self.assertGreater(len(effects), 30)
        done = self.run_program("check", *effects)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("warning", done.stderr)


if __name__ == "__main__":
    main()
