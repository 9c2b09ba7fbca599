"""Outputs say how they were made, and `roil repro` makes them again."""
import json
import os
import shutil
import subprocess

from lib.pictures import packed_pixels
from lib.program import PUFF, SMALL, SOURCE, Case, main

# Each frame is the sum of those before it, so that a picture depends on which were drawn.
TRAIL = """
local fx = effect { name = "trail", frames = 10 }
local size = param { "size", 0.5, min = 0.1, max = 2 }
local word = param { "word", "one", words = {"one", "two"} }
fx.camera = orbit { target = {0, 0, 0}, distance = 6 }
local lit = 1
fx:on_key("f", function() lit = 3 end)
local seen = param { "seen", 1 }
fx:on_frame(function() seen:set(lit) end)
local ball = march { density = sphere { radius = size, falloff = 0.3 } * (2 + time * 12), emission = {0.5, 0.2, 0} , steps = 16 }
local sum = shader { "trail.comp", ball.color, gain = seen }
fx.output = final { sum }.color
return fx
"""
SUM = """// Adds up.
uniform sampler2D input_; //= input : the picture
uniform sampler2D last; //= input history color : the sum
writeonly uniform image2D color; //= output rgba32f : the sum
uniform float gain; //= 1 [0, 10] : factor
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(color))))
        imageStore(color, at, 0.3 * gain * texelFetch(input_, at, 0) + 0.5 * texelFetch(last, at, 0));
}
"""
AIR = """
local fx = effect { name = "air", frames = 4 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2 }
air:source { shape = sphere { position = {0, 0, 0.5}, radius = 0.3 }, density = 1, temperature = 1 }
fx.output = final { march { density = air.density, steps = 4 } }.color
return fx
"""


KINDS = "webm", "mov", "gif", "apng"


class Repro(Case):
    def setUp(self):
        super().setUp()
        self.write("trail.lua", TRAIL)
        self.write("trail.comp", SUM)
        self.write("air.lua", AIR)

    def recipe(self, name):
        raw = self.read(name)
        return json.JSONDecoder().raw_decode(raw[raw.index(b'{"roil-recipe":1,'):].decode("latin-1"))[0]

    def same(self, name, *arguments):
        self.assertIn(f"{name}: the same, bit for bit", self.succeeds("repro", name, *arguments))

    def differs(self, name, *says):
        done = self.run_program("repro", name)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        for text in says:
            self.assertIn(text, done.stdout)

    def test_pictures(self):
        self.succeeds("render", "trail.lua", "--frames", "2-5", "-o", "p%d.png", "-o", "p%d.exr", "--set", "size=0.8",
                      "--set", "word=two", "--event", "0.1 key f", "--16", "--alpha", "--float", *SMALL)
        for name in ("p2.png", "p5.png", "p5.exr"):
            self.same(name)
        made = self.recipe("p5.png")
        self.assertEqual((made["effect"], made["frame"], made["size"]), ("trail.lua", 5, [96, 54]))
        self.assertEqual(made["settings"], {"size": "0.8", "word": "two", "effect.events": "0.1 key f"})
        self.assertIn("--warmup=3", made["options"])
        self.assertRegex(made["inputs"], "^[0-9a-f]{32}$")
        self.succeeds("render", "trail.lua", "--frames", "5", "-o", "alone.png", "--set", "size=0.8", *SMALL)
        self.assertNotEqual(packed_pixels(self.read("alone.png")), packed_pixels(self.read("p5.png")))
        self.assertNotIn("--warmup=3", self.recipe("alone.png")["options"])
        self.same("alone.png")

    def test_what_is_not_the_picture(self):
        self.succeeds("render", "trail.lua", "--frames", "3", "-o", "shown.exr", "--shown", "--dump-pass", "march", "m.exr", *SMALL)
        self.same("shown.exr")
        self.same("m.exr")
        self.write("puff.lua", PUFF)
        self.succeeds("render", "puff.lua", "--frames", "3", "-o", "truth.png", "--reference", "3", "--size", "32x18")
        self.same("truth.png")

    def test_films(self):
        self.succeeds("render", "trail.lua", "--frames", "3-9:2", "--warmup", "1", "--fps", "5", "-o", "film.mp4", *SMALL)
        self.same("film.mp4")
        self.assertEqual(self.recipe("film.mp4")["frames"], [3, 9, 2])
        self.succeeds("render", "trail.lua", "--frames", "3", "-o", "one.mp4", *SMALL)
        self.same("one.mp4")
        self.succeeds("render", "trail.lua", "--frames", "3-5", "--alpha", *SMALL,
                      *[part for kind in KINDS for part in ("-o", "film." + kind)])
        for kind in KINDS:
            self.same("film." + kind)
            self.assertIn("--alpha", self.recipe("film." + kind)["options"])
            if not shutil.which("ffprobe"):
                continue
            said = subprocess.run(["ffprobe", "-v", "warning", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of",
                                   "csv=p=0", self.path("film." + kind)], capture_output=True, text=True, check=True)
            self.assertEqual((said.stdout.strip(), said.stderr), ("3", ""), kind)

    def test_volumes(self):
        self.succeeds("export", "vdb", "air.lua", "-o", "v%d.vdb", "--frames", "1-3", "--fields", "density,velocity",
                      "--tolerance", "0.001")
        for name in ("v1.vdb", "v2.vdb", "v3.vdb"):
            self.same(name)
        self.assertIn("--fields=density,velocity", self.recipe("v2.vdb")["options"])
        self.succeeds("export", "vdb", "trail.lua", "-o", "w%d.vdb", "--frames", "2-4", "--size", "20")
        self.same("w3.vdb", "-o", "kept/w.vdb")
        self.assertEqual(len(self.read("kept/w.vdb")), len(self.read("w3.vdb")))

    def test_sheets(self):
        self.write("puff.lua", PUFF)
        self.succeeds("export", "sheet", "puff.lua", "-o", "out/fire.png", "--grid", "2x2", "--cell", "32", "--frames", "1-4",
                      "--maps", "color,normal", "--light", "both", "--for", "unity", "--crop", "--set", "thickness=9",
                      "--set", "camera.yaw=30", "--page", "out/play.html")
        made = self.recipe("out/fire-normal.png")
        self.assertEqual((made["kind"], made["sheet"], made["part"]), ("sheet", "fire.png", "fire-normal.png"))
        self.assertEqual(made["settings"], {"thickness": "9", "camera.yaw": "30"})
        self.assertEqual(self.recipe("out/fire.json"), json.loads(self.read("out/fire.json"))["made"])
        os.rename(self.path("out/fire-normal.png"), self.path("renamed.png"))
        for name in ("out/fire.png", "out/fire-scene.png", "out/fire.json", "out/play.html", "renamed.png"):
            self.same(name)
        self.succeeds("export", "sheet", "puff.lua", "-o", "raw.exr", "--grid", "2x2", "--cell", "16", "--frames", "1-4",
                      "--samples", "2")
        self.same("raw.exr")
        self.write("puff.lua", PUFF.replace("perlin", "0.5 * perlin"))
        self.differs("out/fire.png", "inputs: then", "as pictures: PSNR")
        self.differs("out/fire.json", "out/fire.json: not the same")
        for old, new in ((b'"part":"fire', b'"part":"../x'), (b'"part":"fire', b'"part":"/etc'), (b'"sheet":"fire', b'"sheet":"-fir')):
            raw = self.read("out/fire.json")
            self.write("bad.json", raw.replace(old, new))
            self.fails(1, "its recipe is damaged", "repro", "bad.json")

    def test_what_has_changed_is_said(self):
        self.succeeds("render", "trail.lua", "--frames", "2", "-o", "a.png", "-o", "a.exr", *SMALL)
        raw = bytearray(self.read("a.exr"))
        raw[-40] ^= 1
        self.write("b.exr", bytes(raw))
        self.differs("b.exr", "b.exr: not the same", "Neither inputs nor roil nor the device have changed")
        self.write("trail.comp", SUM.replace("0.3 *", "0.6 *"))
        self.differs("a.png", "inputs: then", "not the same file; as pictures: PSNR")
        os.rename(self.path("trail.comp"), self.path("gone.comp"))
        self.fails(1, "no such shader", "render", "trail.lua", "--frames", "2", "-o", "x.png", *SMALL)
        done = self.run_program("repro", "a.png")
        self.assertEqual(done.returncode, 1)
        self.assertIn("a.png: it cannot be made again", done.stderr)

    def test_a_stranger_opens_nothing(self):
        self.succeeds("render", "trail.lua", "--frames", "2", "-o", "a.png", *SMALL)
        raw = self.read("a.png")

        def changed(old, new):  # as long as before: the picture around it is not looked at
            self.assertEqual(len(old), len(new))
            at = raw.index(b'{"roil-recipe"')
            self.write("b.png", raw[:at] + raw[at:].replace(old, new, 1))

        changed(b'"effect":"trail.lua"', b'"effect":"../ai.lua"')
        self.fails(1, "its effect lies outside of this folder; name it", "repro", "b.png")
        done = self.run_program("repro", "b.png", "trail.lua")
        self.assertEqual(done.returncode, 3)
        self.assertIn("as pictures: PSNR inf dB", done.stdout)
        os.symlink("/etc", self.path("etc"))
        changed(b'"effect":"trail.lua"', b'"effect":"etc/a.lua"')
        self.fails(1, "etc/a.lua", "repro", "b.png")
        os.remove(self.path("trail.lua"))
        os.symlink(os.path.join(SOURCE, "effects/smoke.lua"), self.path("trail.lua"))
        self.fails(1, "trail.lua: leads out of", "repro", "a.png")
        for old, new in ((b'"size":[96,54]', b'"size":[0,541]'), (b'"frame":2.0', b'"frame":1e9'),
                         (b'"frame":2.0', b'"frame":"x"'), (b'"kind":"picture"', b'"kind":[1,2,3,4]')):
            changed(old, new)
            self.assertEqual(self.run_program("repro", "b.png").returncode, 1, old)
        recipe = json.dumps({**self.recipe("a.png"), "options": ["--output=/tmp/x.png"]}, separators=(",", ":"))
        self.write("c.png", recipe)
        self.fails(1, "its recipe is damaged", "repro", "c.png")
        self.write("c.png", recipe[:100])
        self.fails(1, "its recipe is damaged", "repro", "c.png")
        self.write("d.png", b"\x89PNG")
        self.fails(1, "d.png: it does not say how it was made", "repro", "d.png")
        self.fails(1, "none.png: No such file", "repro", "none.png")

    def test_usage(self):
        self.fails(2, "one file is made again", "repro")
        self.fails(2, "one file is made again", "repro", "a", "b", "c")
        self.fails(2, "did you mean '--output'", "repro", "--outputt", "x", "a.png")


if __name__ == "__main__":
    main()
