"""Simulated air by the program: a plume rises, its readouts and times are told, mistakes are named."""
import json

from lib.pictures import Png, packed_pixels
from lib.program import Case, main

EFFECT = """
local fx = effect { name = "air", fps = 12, frames = 12 }
local air = lbm { size = {16, 16, 32}, voxel_size = 0.1, speed = 2, buoyancy_heat = 8,
  boundary = "periodic"%s }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1, temperature = 1 }
fx.camera = camera { eye = {0, -8, 1.6}, target = {0, 0, 1.6}, fov = 30 }
fx.output = final { march { density = air.density * 10, steps = 32, albedo = {0, 0, 0} } }.color
return fx
"""
SMALL = ["--size", "16x32", "--alpha"]


class Air(Case):
    def rows(self, frame, *options):
        """How opaque the rows of a frame are."""
        self.write("effect.lua", EFFECT % "")
        said = self.succeeds("render", "effect.lua", "--frames", str(frame), *SMALL, "-o", "o.png", *options)
        return said, [sum(row[3::4]) for row in Png(self.read("o.png")).rows]

    def test_a_plume_rises(self):
        def top(rows):
            return next(i for i, alpha in enumerate(rows) if alpha > 200)

        _, first = self.rows(1)
        said, last = self.rows(12, "--stats", "stats.json")
        self.assertLess(top(last), top(first) - 3)
        self.assertIn("time step 0.005 s", said)
        stats = json.loads(self.read("stats.json"))
        self.assertEqual(stats["readouts"]["lbm.steps"], 185)
        self.assertAlmostEqual(stats["readouts"]["lbm.tau"], 0.50003, 4)
        for part in ("lbm.step", "lbm.sources", "lbm.fields"):
            self.assertIn(part, stats["median_gpu_ms"])

    def test_no_device_is_needed_to_check(self):
        self.write("effect.lua", EFFECT % "")
        self.assertIn("effect.lua: good", self.succeeds("check", "effect.lua"))

    def test_a_mistyped_option_gets_a_suggestion(self):
        self.write("effect.lua", EFFECT % ", bouyancy_density = 1")
        self.fails(1, ["effect.lua:3:", "did you mean 'buoyancy_density'?"], "check", "effect.lua")

    def test_a_step_that_is_too_long_is_told(self):
        self.write("effect.lua", EFFECT % ", time_step = 0.02, guard = 'stop'")
        done = self.run_program("render", "effect.lua", "--frames", "4", *SMALL, "-o", "o.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, "lbm: .*'time_step' below")

    def test_motion_is_the_place_of_meshes(self):
        """Said for all, and in the mesh itself: the same picture."""
        self.write("ball.obj", "v 0 0 0\nv 0.4 0 0\nv 0 0.4 0\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        path = "curve { {0, {-0.7, 0, 0.5}}, {1, {0.3, 0, 0.9}} }"
        pictures = []
        for collider in (f"mesh {{ 'ball.obj', position = {path} }}", f"mesh 'ball.obj', motion = {path}",
                         "mesh { 'ball.obj' }"):
            self.write("effect.lua", EFFECT.replace("fx.camera", f"air:collider {{ {collider} }}\nfx.camera", 1) % "")
            self.succeeds("render", "effect.lua", "--frames", "4", *SMALL, "-o", "o.png")
            pictures.append(packed_pixels(self.read("o.png")))
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])
        self.write("effect.lua", EFFECT.replace("fx.camera", f"air:source {{ mesh {{ 'ball.obj', position = {path} }}, "
                                                             f"density = 1, motion = {path} }}\nfx.camera", 1) % "")
        self.fails(1, "source: 'motion' is given, and the mesh's own 'position', too", "check", "effect.lua")

    def test_frames_that_are_none_of_the_effects_are_told(self):
        self.write("effect.lua", EFFECT.replace("frames = 12", "frames = 2") % "")
        for command, output in (["render", *SMALL], "o.png"), (["export", "vdb"], "o.vdb"):
            for frame, is_told in ("3", True), ("2", False):
                done = self.run_program(*command, "effect.lua", "--frames", frame, "-o", output)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual("frame 3 is none of the effect's, which are 1 to 2" in done.stderr, is_told)

    def test_velocity_is_exported_though_nothing_draws_it(self):
        self.write("effect.lua", EFFECT % "")
        self.assertIn("of density, temperature, velocity,",
                      self.succeeds("export", "vdb", "effect.lua", "--frames", "4", "-o", "o.vdb"))


main()
