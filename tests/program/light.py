"""Light where it makes no sense: every effect ends in a message, or in a picture of finite numbers."""
import math

from lib.pictures import Exr
from lib.program import Case, main

CUBE = "".join(f"v {x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)) + \
    "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n"

# One medium thrice: lit by `lighting`, by itself, and traced. `{name}` are the values below.
LIT = """
local fx = effect {{ name = "lit", fps = 24, frames = 4 }}
local p = param {{ "p", 0, min = 0, max = 1, help = "what is divided by it is no number" }}
fx.camera = {camera}
fx.sun = {sun}
fx.sky = {sky}
fx.lights = {lights}
local x = position.x
local medium = {{ density = {density}, emission = {emission}, {medium} }}
local function with(more)
  for key, value in pairs(medium) do more[key] = more[key] or value end
  return more
end
local lit = lighting(with {{ shadow_resolution = 16, glow_resolution = 8, sweeps = 1 }})
local scene = geometry {{ {meshes} }}
local solid = shade {{ from = {{scene, lit}}, shadow_samples = 2, sky_samples = 2 }}
local cached = march {{ from = {{lit, scene}}, steps = 8, near_steps = 1 }}
local nested = march(with {{ from = scene, steps = 4, shadow_steps = 2, mesh_shadows = "on", scattering = "octaves", tolerance = 0.05 }})
local traced = reference(with {{ from = scene, samples = 1, {reference} }})
local calm = accumulate {{ from = cached, source = cached.color, depth = scene.depth }}
local one = over {{ volume = calm.color, edge = cached.edge, source = solid, depth = scene.depth }}
local two = over {{ volume = nested.color, edge = nested.edge, source = one, depth = scene.depth }}
local exposed = meter {{ two }}
fx.output = final {{ two, exposure = exposed }}.color
fx.linear = two
return fx
"""
VALUES = {
    "camera": "orbit { target = {0, 0, 1}, distance = 5 }",
    "sun": "sun { strength = 2 }",
    "sky": "sky { strength = 1 }",
    "lights": "{ point_light { position = {2, -1, 2}, power = 100 } }",
    "density": "sphere { position = {0, 0, 1}, radius = 1, falloff = 0.5 } * 4",
    "emission": "vec(0.5, 0.2, 0)",
    "medium": "",
    "meshes": 'mesh { "ground.obj" }',
    "reference": "",
}


class Light(Case):
    def setUp(self):
        super().setUp()
        self.write("cube.obj", CUBE)

    def is_finite(self, *args, **values):
        """Renders two frames; the brightest number of the second."""
        self.write("lit.lua", LIT.format(**{**VALUES, **values}))
        self.succeeds("render", "lit.lua", "--frames", "1,2", "--size", "24x14", "--float", "-o", "%d.exr",
                      "--dump-pass", "reference", "traced%d.exr", *args)
        most = 0
        for name in ("1.exr", "2.exr", "traced1.exr", "traced2.exr"):
            for channel, numbers in Exr(self.read(name)).channels.items():
                self.assertTrue(all(math.isfinite(v) for v in numbers), f"{name} {channel} {values}")
                if name in ("1.exr", "2.exr"):
                    self.assertGreaterEqual(min(numbers), 0, f"{name} {channel} {values}")
                    most = max(most, *numbers)
        return most

    def is_refused(self, says, **values):
        self.refuses(LIT.format(**{**VALUES, **values}), says)

    # ---- the medium

    def test_density_below_0_is_nothing(self):
        nothing = self.is_finite(density="sphere { radius = 1 } * 0")
        self.assertEqual(self.is_finite(density=VALUES["density"].replace("4", "-4")), nothing)

    def test_density_beyond_measure(self):
        self.is_finite(density=f"({VALUES['density']}) * x * 1e30")
        self.is_finite(density=f"({VALUES['density']}) * x * 1e30 * 1e30")
        self.is_finite(density=f"({VALUES['density']}) * 1e30", emission="vec(1e30, -1e30, 1 / p)")

    def test_medium_that_is_none(self):
        self.is_finite(medium="albedo = vec(1 / p, 0 / p, 1), extinction = 1000, anisotropy = 1 / p, "
                       "temperature = 1e30, blackbody_intensity = 1e30, tint = {5, -5, 0}")

    def test_bounds_of_a_reference_far_too_low_and_high(self):
        self.is_finite(reference="majorant_scale = 0.01")
        self.is_finite(reference="majorant_scale = 100, bounces = 1024")

    # ---- lights

    def test_lights_of_all_kinds_of_nonsense(self):
        self.is_finite(lights="""{
          sphere_light { position = {0, 0, 1}, radius = 0 }, sphere_light { position = {0, 0, 1}, radius = 1000 },
          point_light { position = {1, 0, 2}, power = 0 }, point_light { position = {1, 0, 2}, power = -5 * (1 + p) },
          point_light { position = {1, 0, 2}, power = 1e30 }, point_light { position = vec(0 / p, 1 / p, 0), power = 1 / p },
          spot_light { position = {0, 0, 3}, target = {0, 0, 3}, angle = 180, softness = 0 },
          spot_light { position = {0, 0, 3}, angle = 0.1 }, spot_light { position = {0, 0, 3}, angle = 360 * (p + 1) } }""")

    def test_as_many_lights_as_there_may_be(self):
        many = "(function() local l = {{}} for i = 1, %d do l[i] = point_light {{ position = {{i, 0, 2}} }} end return l end)()"
        many = many.replace("{{", "{").replace("}}", "}")
        self.is_finite(lights=many % 63)
        self.is_refused("64 lights; at most 63 are possible", lights=many % 64)
        self.refuses(LIT.format(**{**VALUES, "lights": many % 30}).replace("resolution = 16", "resolution = 256"),
                     ["shadows of 31 lights", "shadow_resolution of 256; at most 66"])

    def test_camera_at_a_light_in_a_mesh_in_the_volume(self):
        self.is_finite(camera="camera { eye = {0, 0, 1}, target = {0, 0, 1} }",
                       lights="{ point_light { position = {0, 0, 1} } }", meshes='mesh { "cube.obj" }')

    def test_sun_and_sky_that_are_none(self):
        self.is_finite(sun="sun { elevation = -90, angle = 180, strength = 1e30, color = {1e30, 1, 1} }",
                       sky="sky { zenith = {1e30, 1, 1}, strength = 1e30 }")
        self.is_finite(sun="sun { elevation = 1 / p, azimuth = 0 / p, strength = -1 * (1 + p), angle = 1 / p }",
                       sky="sky { strength = 0 / p, horizon = vec(-1 / p, 0, 0) }")

    def test_panoramas_of_any_shape(self):
        self.write("plain.lua", 'local fx = effect { name = "plain" }\nfx.output = shade { from = geometry {} }\nreturn fx\n')
        for size in ("1x1", "1x4096", "8192x1"):
            self.succeeds("render", "plain.lua", "--frames", "1", "--size", size, "-o", "sky.exr")
            self.is_finite(sky='sky { image = "sky.exr", strength = 1 / p, rotation = 1 / p }')
        self.succeeds("render", "plain.lua", "--frames", "1", "--set", "sky.strength=0", "-o", "sky.exr")
        self.is_refused("all black", sky='sky { image = "sky.exr" }')

    # ---- meshes

    def test_meshes_of_no_size(self):
        self.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
        scales = ("0", "-1", "1e-30", "1e30", "0 / p")
        meshes = [f'mesh {{ "cube.obj", scale = {scale}, position = {{2, 0, 0}} }}' for scale in scales]
        meshes += ['mesh { "line.obj" }', 'mesh { "cube.obj", color = vec(-5, 1e30, 0 / p), position = vec(1 / p, 0, 0) }']
        self.is_finite(meshes=", ".join(meshes))

    def test_many_meshes(self):
        many = "(function() local l = {} for i = 1, %d do l[i] = mesh { 'cube.obj', scale = 0.1 } end return table.unpack(l) end)()"
        self.is_finite(meshes=many % 256)
        self.is_refused("257 meshes; at most 256 are possible", meshes=many % 257)

    # ---- passes

    def test_dark_pictures_have_an_exposure(self):
        dark = self.is_finite(sun="sun { strength = 0 }", sky="sky { strength = 0 }", lights="{}", emission="vec(0, 0, 0)")
        self.assertEqual(dark, 1)  # the opacity

    def test_from(self):
        head = 'local fx = effect { name = "from" }\nlocal a = geometry {}\n'
        for wrong, got in (("a.albedo", "an image"), ("'a'", "a string"), ("{{a}}", "a table"), ("{ b = a }", "without names")):
            self.refuses(head + f"local b = march {{ from = {wrong}, density = sphere {{}} }}\n", ["'from' takes", got])
        self.write("chain.lua", head + 'local m = march { density = sphere {} }\n'
                   'for i = 1, 50 do m = march { from = m, name = "m" .. i } end\nfx.output = m.color\nreturn fx\n')
        self.succeeds("render", "chain.lua", "--frames", "1", "--size", "8x8", "--set", "march.steps=2")

    def test_reference_as_a_film(self):
        self.is_finite("--reference", "3", "-o", "film.mp4")
        self.assertGreater(len(self.read("film.mp4")), 500)


if __name__ == "__main__":
    main()
