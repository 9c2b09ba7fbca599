"""Templates of flows and of simulated air by the program: they stir, the same in every frame rate and jump, and mistakes are named."""
import os
import shutil

from lib.pictures import Png
from lib.program import SOURCE, Case, main

EFFECT = """
local fx = effect { name = "templates", fps = %s, frames = 24 }
local flow = slices { count = 1, size = {32, 32}, height = 1, buoyancy_heat = 2 }
flow:inflow { shape = disc { 0.5, 0.2, radius = 0.15 }, density = 1, temperature = 1 }
%s
fx.camera = camera { eye = {0, -3, 0.5}, target = {0, 0, 0.5}, fov = 20 }
fx.output = final { march { density = flow.density * box { position = {0, 0, 0.5}, size = {1, 0.1, 1} } * 20, steps = 32, albedo = {0, 0, 0} } }.color
return fx
"""
STIRRED = """
flow:templates { image "templates/vortex_left.exr", kind = "velocity", count = 12, size = {0.2, 0.5},
                 lifetime = {0.1, 0.3}, strength = 30, within = "density", above = 0.1 }
"""
AIR = """
local fx = effect { name = "templates", fps = 12, frames = 24 }
local air = %s { size = {16, 16, 16}, voxel_size = 0.1, time_step = 0.02 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, temperature = 900, during = {0, 0.05} }
%%s
fx.output = final { march { density = air.temperature, steps = 8 } }.color
return fx
"""
GOOD = 'image "templates/source.exr"'
SMALL = ["--size", "16x16", "--alpha"]


class Templates(Case):
    def write_effect(self, line, fps=12):
        os.makedirs(self.path("templates"), exist_ok=True)
        for name in ("source", "vortex_left"):
            shutil.copy(os.path.join(SOURCE, "effects", "templates", name + ".exr"), self.path("templates"))
        self.write("effect.lua", EFFECT % (fps, line))

    def picture(self, line, frames, fps=12):
        """The last of these frames."""
        self.write_effect(line, fps)
        self.succeeds("render", "effect.lua", "--frames", frames, *SMALL, "-o", "o.%04d.png" if "-" in frames else "o.png")
        name = "o.%04d.png" % int(frames.split("-")[1]) if "-" in frames else "o.png"
        return Png(self.read(name)).rows

    def test_they_stir_the_same_at_any_frame_rate(self):
        plain, stirred = self.picture("", "7"), self.picture(STIRRED, "7")
        self.assertNotEqual(plain, stirred)
        self.assertEqual(stirred, self.picture(STIRRED, "1-7"))
        self.assertEqual(stirred, self.picture(STIRRED, "13", fps=24)) # half a second, too

    def refused(self, line, *messages):
        self.write_effect(line)
        self.fails(1, ["effect.lua:5:", *messages], "check", "effect.lua")

    def test_good_ones_need_no_device(self):
        self.write_effect("""flow:templates { %s, size = 0.1, lifetime = {curve { {0, 0.1}, {1, 0.2} }, 0.4}, center = {0.5, 0.2},
            align = "radial", region = disc { 0.5, 0.2, radius = 0.2 }, strength = function(t) return 3 - t end }""" % GOOD)
        self.assertIn("effect.lua: good", self.succeeds("check", "effect.lua"))

    def test_mistakes_are_named(self):
        self.refused("flow:templates { %s, lifetimes = 1 }" % GOOD, "did you mean 'lifetime'?")
        self.refused("flow:templates { %s, kind = 'velocities' }" % GOOD, "accepted: pressure, velocity")
        self.refused("flow:templates { %s, size = {1, 2, 3} }" % GOOD, "'size' takes two numbers {least, most}, or one")
        self.refused("flow:templates { %s, center = 1 }" % GOOD, "'center' takes two numbers {x, y}")
        self.refused("flow:templates { %s, count = 5000 }" % GOOD, "'count' is 5000; a flow has 1 to 4096 templates")
        self.refused("flow:templates { %s, strength = perlin { 1 } }" % GOOD, "strength")
        self.refused("flow:templates { count = 3 }", "its picture comes first", "got nil")
        self.refused("flow:templates { 'templates/source.exr' }", "its picture comes first", "got a string")
        self.refused("flow:templates { %s, %s }" % (GOOD, GOOD), "templates")
        self.refused("flow.templates { %s }" % GOOD, "mind the ':'")

    def air_refuses(self, line, *messages, kind="pyro"):
        self.write_effect("")
        self.write("effect.lua", AIR % kind % line)
        self.fails(1, ["effect.lua:5:", *messages], "check", "effect.lua")

    def test_air_takes_good_ones(self):
        self.write_effect("")
        for kind, held in ("pyro", "soot"), ("lbm", "dye"):
            self.write("effect.lua", AIR % kind % """air:templates { %s, size = 0.1, lifetime = {0.1, 0.4}, center = {0.5, 0.2, 1},
                align = "radial", region = sphere { position = {0, 0, 1} }, strength = curve { {0, 1}, {1, 0} }, within = "%s" }
                air:templates { %s, kind = "velocity", depth = "extrude", align = "direction", direction = curl { frequency = 1 },
                count = 3, angle = 20, spread = 10, seed = 4, scale_by = "temperature" }""" % (GOOD, held, GOOD))
            self.assertIn("effect.lua: good", self.succeeds("check", "effect.lua"))

    def test_mistakes_in_air_are_named(self):
        self.air_refuses("air:templates { %s, lifetimes = 1 }" % GOOD, "did you mean 'lifetime'?")
        self.air_refuses("air:templates { %s, blend = 0.1 }" % GOOD, "unknown key 'blend'")
        self.air_refuses("air:templates { %s, within = 'density' }" % GOOD, "accepted: nothing, temperature, fuel, soot")
        self.air_refuses("air:templates { %s, within = 'soot' }" % GOOD, "accepted: nothing, density, temperature, dye", kind="lbm")
        self.air_refuses("air:templates { %s, depth = 'turn' }" % GOOD, "accepted: revolve, extrude")
        self.air_refuses("air:templates { %s, size = {1, 2, 3} }" % GOOD, "'size' takes two numbers {least, most}, or one")
        self.air_refuses("air:templates { %s, count = 5000 }" % GOOD, "'count' is 5000; a flow has 1 to 4096 templates")
        self.air_refuses("air:templates { %s, align = 'direction' }" % GOOD, "wants a field, as in direction = vec(0, 0, 1)")
        self.air_refuses("air:templates { %s, direction = {1, 0, 0} }" % GOOD, "say align = \"direction\", too")
        self.air_refuses("air:templates { %s, region = air.temperature }" % GOOD, "'region' reads the air that it is given to", "'within'")
        self.air_refuses("air:templates { %s, align = 'direction', direction = air.velocity }" % GOOD, 'align = "flow" go by it')
        self.air_refuses("air:templates { count = 3 }", "its picture comes first", "got nil")
        self.air_refuses("air.templates { %s }" % GOOD, "mind the ':'")
        self.air_refuses("air:template { %s }" % GOOD, "did you mean 'templates'?")

    def test_broken_pictures_are_refused(self):
        self.write("broken.exr", "not a picture")
        self.write("broken.png", "not a picture")
        self.refused('flow:templates { image "broken.exr" }', "broken.exr")
        self.refused('flow:templates { image "broken.png" }', "broken.png")
        self.refused('flow:templates { image "missing.exr" }', "missing.exr")
        self.refused('flow:templates { image "../outside.exr" }', "outside.exr")


main()
