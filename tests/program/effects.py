"""Bad effect files: the message names file and line, and says what is accepted."""
import os

from lib.pictures import packed_pixels
from lib.program import PUFF, SMALL, Case, main

PASSES = 'local fx = effect { name = "bad" }\n'


class Effects(Case):
    def test_missing_file(self):
        for command in ("check", "render"):
            self.fails(1, ["none.lua", "No such file"], command, "none.lua")

    def test_good_and_bad_files_are_told_apart(self):
        self.write("good.lua", PUFF)
        self.write("bad.lua", "fx =\n")
        self.assertIn("good.lua: good", self.succeeds("check", "good.lua"))
        done = self.run_program("check", "good.lua", "bad.lua", "good.lua")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout.count("good.lua: good"), 2)  # goes on after the bad one
        self.assertIn("bad.lua:", done.stderr)

    def test_syntax_error(self):
        self.refuses(PASSES + "fx.output = = 3\n", ["effect.lua:2:", "unexpected symbol"])

    def test_bytecode_is_refused(self):
        self.write("effect.lua", b"\x1bLua\x54\x00\x19\x93\r\n\x1a\n")
        self.fails(1, "effect.lua", "check", "effect.lua")

    def test_error_below_a_function_says_who_called(self):
        message = self.refuses("local function a() return nil + 1 end\nlocal x = a()\n", "arithmetic")
        self.assertIn("effect.lua:1:", message)
        self.assertIn("\ncalled from effect.lua:2", message)

    def test_rendering_says_the_same(self):
        self.cannot_draw(PASSES + "fx.output = = 3\n", ["effect.lua:2:", "unexpected symbol"])

    def test_endless_loop(self):
        self.refuses("while true do end\n", ["effect.lua:1:", "instruction limit"])

    def test_endless_memory(self):
        self.refuses('local t = {}\nfor i = 1, 1e9 do t[i] = ("x"):rep(1000) .. i end\n', "memory")

    def test_values_of_the_wrong_kind_say_what_is_right(self):
        march = 'fx.output = final { march { density = %s } }.color\nreturn fx\n'
        lit = 'lighting { density = sphere { radius = 1 }, albedo = %s }\n'
        self.refuses(lit % '"red"', ["'albedo' must be a colour as \"#rrggbb\", or", 'got "red"'])
        self.refuses(lit % "worley { frequency = 1 }", ["'albedo' varies in space", "'tint'"])
        self.refuses(PASSES + "fx.camera = orbit { target = {0, 1} }\n", "'target' takes three numbers, {x, y, z}")
        self.refuses(PASSES + march % "sphere { position = {0, 1} }", "'position' takes three numbers, {x, y, z}")
        for density, cause in (("sphere { radius = 1 } - worley { frequency = 1 }", "because of '-'"),
                               ("clamp(sphere { radius = 1 } + 0.5, 0, 2)", "because of '+'"),
                               ("2 * worley { frequency = 1 }", "because of 'worley'")):
            self.refuses(PASSES + march % density, ["fills all of space", cause])

    def test_particles_that_nothing_draws_are_told(self):
        self.write("puff.lua", PUFF.replace("return fx", "local sparks = particles { rate = 10 }\nreturn fx"))
        done = self.run_program("check", "puff.lua")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("puff.lua: nothing draws or reads 'particles'", done.stderr)

    def test_unknown_global_gets_a_suggestion(self):
        self.refuses(PASSES + "local f = perlinn { frequency = 2 }\n",
                     ["effect.lua:2:", "perlinn", "did you mean 'perlin'?"])

    def test_unknown_keys_get_a_suggestion(self):
        self.refuses(PASSES + "fx.output = march { densty = 1 }.color\n",
                     ["effect.lua:2:", "densty", "did you mean 'density'?"])
        self.refuses(PASSES + "local f = sphere { radus = 1 }\n", ["effect.lua:2:", "did you mean 'radius'?"])
        self.refuses(PASSES + "fx.outptu = 1\n", ["effect.lua:2:", "did you mean 'output'?"])
        self.refuses(PASSES + 'fx.output = final { geometry {}.albedo, tonemap = "agxx" }.color\n',
                     ["effect.lua:2:", "agxx", "agx"])

    def test_uniform_out_of_range(self):
        self.refuses(PASSES + "fx.output = march { density = 1, anisotropy = 2 }.color\n",
                     ["effect.lua:2:", "anisotropy", "0.95"])

    def test_wrong_types(self):
        self.refuses(PASSES + 'fx.output = march { density = 1, steps = "many" }.color\n',
                     ["effect.lua:2:", "steps"])
        self.refuses(PASSES + "fx.output = march { density = {1, 2, 3} }.color\n",
                     ["effect.lua:2:", "density"])
        self.refuses(PASSES + "fx.output = final { 3 }.color\n", ["effect.lua:2:"])
        self.refuses(PASSES + "fx.output = 5\n", ["effect.lua:2:", "output"])

    def test_palette_with_one_stop(self):
        self.refuses(PASSES + 'local p = palette { {0, "#ff0000"} }\n', ["effect.lua:2:", "palette", "2"])

    def test_cyclic_graph(self):
        self.write("loop.comp", """
uniform sampler2D source; //= input : any
writeonly uniform image2D color; //= output rgba16f : it
void main() { imageStore(color, ivec2(gl_GlobalInvocationID.xy), texture(source, vec2(0.5))); }
""")
        self.refuses(PASSES + 'local a = shader { "loop.comp", source = later }\n'
                     "later = a\nfx.output = a\n", "effect.lua:2:")

    def test_effect_without_output(self):
        self.refuses(PASSES, ["effect.lua", "output"])
        self.refuses("", "effect.lua")

    def test_effect_cannot_reach_out(self):
        os.makedirs(self.path("inner"))
        self.write("outside.lua", "return {}\n")
        self.write("outside.obj", "v 0 0 0\n")
        for line in ('vdb { "../x.vdb" }', 'vdb { "/etc/*.vdb" }', 'mesh { "../outside.obj" }',
                     'require "../outside"', 'shader { "../x.comp" }', "io.open('x')",
                     "os.execute('true')", "dofile('x')", "debug.getinfo(1)"):
            with self.subTest(line):
                self.write("inner/effect.lua", PASSES + f"local x = {line}\n")
                self.fails(1, "effect.lua:2:", "check", "inner/effect.lua")


class Settings(Case):
    def setUp(self):
        super().setUp()
        self.write("puff.lua", PUFF)

    def set(self, status, says, text):
        self.fails(status, says, "render", "puff.lua", "--frames", "1", "-o", "out.png", *SMALL,
                   "--set", text)
        self.assertFalse(os.path.exists(self.path("out.png")))

    def test_unknown_name_gets_a_suggestion(self):
        self.set(1, ["thicknes", "did you mean 'thickness'?"], "thicknes=5")
        self.set(1, ["march", "stepz", "did you mean 'steps'?"], "march.stepz=5")
        self.set(1, "nothing_like_it", "nothing_like_it=5")

    def test_out_of_range(self):
        self.set(1, ["thickness", "101", "0", "100"], "thickness=101")
        self.set(1, "thickness", "thickness=-1")
        self.set(1, "thickness", "thickness=nan")
        self.set(1, "anisotropy", "march.anisotropy=3")

    def test_wrong_type(self):
        self.set(1, ["thickness", "much"], "thickness=much")
        self.set(1, "thickness", "thickness=")
        self.set(1, ["steps", "8.5"], "steps=8.5")
        self.set(1, ["look", "loud", "soft", "hard"], "look=loud")
        self.set(1, ["mode", "fast", "paper"], "march.mode=fast")

    def test_settings_change_the_picture(self):
        self.render(PUFF)
        before = packed_pixels(self.read("out.png"))
        for text in ("thickness=40", "march.albedo=1,0,0", "march.mode=paper", "final.exposure_ev=2"):
            with self.subTest(text):
                self.render(PUFF, "--set", text)
                self.assertNotEqual(packed_pixels(self.read("out.png")), before)


if __name__ == "__main__":
    main()
