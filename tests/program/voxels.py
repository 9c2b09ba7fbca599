"""Meshes as fields, from Lua: smoke that fills one, goes with it and keeps its distance."""
from lib.pictures import Png
from lib.program import Case, main

CUBE = "".join(f"v {x} {y} {z}\n" for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) + """
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""
# The cube moves to the right in a second; the camera looks along +Y.
EFFECT = """
local fx = effect { name = "voxels", fps = 10, frames = 11 }
fx.camera = camera { eye = {0, -8, 0}, target = {0, 0, 0}, fov = 40 }
local cube = mesh { "cube.obj", position = curve { {0, {-1, 0, 0}}, {1, {1, 0, 0}} }, scale = 0.5 }
local space = { min = {-2, -1, -1}, max = {2, 1, 1} }
local body = voxels { cube, box = space, resolution = 64, rule = "solid" }
local volume = march { density = %s, steps = 32, albedo = {0, 0, 0} }
fx.output = final { volume }.color
return fx
"""
SMALL = ["--size", "32x18", "--alpha"]
WITHIN = "box { position = {0, 0, 0}, size = {4, 2, 2} }"


class Voxels(Case):
    def setUp(self):
        super().setUp()
        self.write("cube.obj", CUBE)

    def columns(self, density, frame, *options):
        """Of the row through the middle, how opaque 32 columns are, 0 to 255."""
        self.write("effect.lua", EFFECT % density)
        self.succeeds("render", "effect.lua", "--frames", str(frame), *SMALL, "-o", "o.png", *options)
        picture = Png(self.read("o.png"))
        self.assertEqual(picture.channels, 4)
        return picture.rows[9][3::4]

    # The picture is 10.35 m wide at the cube, so that a column is 0.32 m.
    def covered(self, columns):
        return [i for i, alpha in enumerate(columns) if alpha > 100]

    def test_smoke_fills_a_mesh_and_goes_with_it(self):
        first = self.covered(self.columns("body.inside * 100", 1))
        last = self.covered(self.columns("body.inside * 100", 11))
        self.assertTrue(11 <= first[0] and first[-1] <= 15, first)
        self.assertTrue(16 <= last[0] and last[-1] <= 20, last)
        self.assertEqual(len(last), len(first))

    def test_rules_are_options(self):
        whole = self.columns("body.inside", 1)
        shell = self.columns("body.inside", 1, "--set", "voxels.rule=shell")
        middle = self.covered([255 * (a > 20) for a in whole])[1]
        self.assertGreater(whole[middle], 140)  # a metre of it
        self.assertLess(shell[middle], 60)      # two walls

    def test_distance_and_velocity_are_fields(self):
        around = f"{WITHIN} * smoothstep(0.35, 0.3, body.distance) * step(0, body.distance) * 100"
        near = self.covered(self.columns(around, 6))
        solid = self.covered(self.columns("body.inside * 100", 6))
        self.assertTrue(near[0] < solid[0] and near[-1] > solid[-1], (near, solid))
        moving = self.columns("body.inside * body.velocity.x * 50", 6)
        self.assertEqual(self.covered(moving), [])  # it was put there
        self.write("effect.lua", EFFECT % "body.inside * body.velocity.x * 50")
        self.succeeds("render", "effect.lua", "--frames", "5-6", *SMALL, "-o", "o-%d.png")
        self.assertEqual(self.covered(Png(self.read("o-6.png")).rows[9][3::4]), solid)

    def test_what_is_wrong_is_said(self):
        for call, message in (
                ("voxels { }", "voxels: a mesh is missing"),
                ("voxels { mesh { 'cube.obj' }, resolution = 2 }", "'resolution' is 2"),
                ("voxels { mesh { 'cube.obj' }, size = {30, 32, 32} }", "a multiple of 4"),
                ("voxels { mesh { 'cube.obj' }, rule = 'hollow' }", "accepted: auto, solid, shell"),
                ("voxels { mesh { 'cube.obj' }, sise = 3 }", "did you mean 'size'?"),
                ("voxels { mesh { 'cube.obj' }, box = { min = {0, 0, 0} } }", "'box' must be"),
                ("voxels { mesh { 'cube.obj' } }.insid", "did you mean 'inside'?"),
                ("voxels { sphere { } }", "meshes")):
            with self.subTest(call):
                self.write("bad.lua", f'effect {{ name = "bad" }}\nlocal a = {call}\n')
                self.fails(1, ["bad.lua:2:", message], "check", "bad.lua")


if __name__ == "__main__":
    main()
