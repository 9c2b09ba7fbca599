"""Numbers that move: beyond the range of what they are given to they are cut off, and that is told once."""
from lib.program import SMALL, Case, main

EFFECT = """
local fx = effect { name = "numbers", fps = 10, frames = 4 }
local p = param { "p", 1, min = 0, max = 100 }
local far = march { name = "far", density = sphere { }, steps = 4, shadow_steps = 0,
  %s }
local volume = march { from = far,
  %s }
fx.output = over { far, volume }.color
return fx
"""
AIR = """
local fx = effect { name = "air", fps = 12, frames = 12 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, boundary = "periodic",
  viscosity = function(t) return -0.5 * t end }
air:source { shape = sphere { position = {0, 0, 0.8}, radius = 0.3 }, density = 1,
  rate = curve { {0, 1}, {0.1, -1} } }
fx.output = march { density = air.density, steps = 8 }.color
return fx
"""


class Numbers(Case):
    def warnings(self, effect, *args, frames="1-4"):
        self.write("effect.lua", effect)
        done = self.run_program("render", "effect.lua", "--frames", frames, *SMALL, "-o", "%04d.png", *args)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [line for line in done.stderr.splitlines() if line.startswith("warning: ")]

    def test_what_moves_within_its_range_is_not_told_of(self):
        ends = "ambient = curve { {0, 0}, {0.15, 10}, {0.3, 0} }"
        self.assertEqual(self.warnings(EFFECT % (ends, "steps = function(t) return 4 + 10 * t end")), [])

    def test_a_function_is_told_of_once_and_with_its_line(self):
        self.assertEqual(
            self.warnings(EFFECT % ("", "steps = function(t) return -3 end, jitter = 0.5")),
            ["warning: effect.lua:6: march: uniform 'steps' is -3 at 0 s; accepted: 1 to 4096; it counts as 1"])

    def test_what_others_take_over_is_told_of_where_it_is_said(self):
        said = self.warnings(EFFECT % ("ambient = curve { {0.05, 5}, {0.15, 20} }", "steps = 4"))
        self.assertEqual(len(said), 1, said)
        self.assertIn("effect.lua:4: far: uniform 'ambient' is 12.5 at 0.1 s; accepted: 0 to 10; it counts as 10",
                      said[0])

    def test_each_number_is_told_of(self):
        said = self.warnings(EFFECT % ("", "early_exit = 2 * p, powder = p * 1e30 * 1e30"))
        self.assertEqual(len(said), 2, said)
        self.assertIn("'early_exit' is 2 at 0 s; accepted: 0 to 1; it counts as 1", said[0])
        self.assertIn("'powder' is inf at 0 s; accepted: 0 to 1; it counts as 0", said[1])

    def test_numbers_of_steps_are_told_of_too(self):
        said = self.warnings(AIR, frames="3")
        self.assertEqual(len(said), 2, said)
        self.assertRegex(said[0] + said[1], "effect.lua:3: lbm: uniform 'viscosity' is -.* accepted: 0 m\\^2/s or more")
        self.assertRegex(said[0] + said[1], "effect.lua:5: lbm_source: uniform 'rate' is -")


main()
