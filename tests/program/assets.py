"""Folders of assets: effects read there what they name, and nowhere else."""
import os
import shutil

from lib.program import CORPUS, SMALL, Case, main

EFFECT = """
local tint = require "tint"
local fx = effect { name = "assets" }
local burst = vdb { "grids/*.vdb" }
local scene = geometry { mesh { "tent.obj" } }
local solid = shade { from = scene }
local smoke = march { density = burst.density * tint, steps = 4, shadow_steps = 1, depth = scene.depth }
fx.output = final { shader { "haze.comp", over { smoke, solid } } }.color
return fx
"""
HAZE = """// Passes it on.
#include "gain.glsl"
uniform sampler2D input_; //= input : the picture
writeonly uniform image2D color; //= output rgba16f : the same
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(color)))) imageStore(color, at, texelFetch(input_, at, 0) * GAIN);
}
"""


class Assets(Case):
    def setUp(self):
        super().setUp()
        self.write("show/effect.lua", EFFECT)
        self.write("one/tent.obj", self.read("ground.obj"))
        self.write("one/grids/a1.vdb", "")
        shutil.copy(os.path.join(CORPUS, "fuzz_vdb/float.vdb"), self.path("one/grids/a1.vdb"))
        self.write("two/tint.lua", "return 2")
        self.write("two/haze.comp", HAZE)
        self.write("two/gain.glsl", "#define GAIN 1.0\n")

    def draws(self, *arguments, **options):
        self.succeeds("render", "show/effect.lua", "--frames", "1", "-o", "out.png", *SMALL, *arguments, **options)

    def check(self, status, *arguments, says="", **options):
        done = self.run_program("check", "show/effect.lua", *arguments, **options)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertIn(says, done.stderr)
        return done.stderr

    def test_several_folders(self):
        self.draws("--assets", "one", "--assets", "two")
        self.check(0, "--assets", "two", "--assets", self.path("one"))
        self.assertTrue(self.succeeds("info", "params", "show/effect.lua", "--assets", "one", "--assets", "two"))
        self.check(1, "--assets", "one", says="no module 'tint'")
        self.check(1, "--assets", "two", says="grids/*.vdb: no file has such a name")
        self.check(1, "--assets", "none", says="--assets none: there is no such folder")
        self.check(1, *["--assets", "one"] * 9, says="more than 8 folders of assets")

    def test_environment_and_project(self):
        self.check(0, environment={"ROIL_ASSETS": f"one::{self.path('two')}"})
        self.check(1, environment={"ROIL_ASSETS": "one:none"}, says="ROIL_ASSETS none: there is no such folder")
        self.write("roil.json", '{"assets": ["one", "two"]}')
        self.draws()
        self.folder, kept = self.path("show"), self.folder  # the file lies above the current folder
        self.succeeds("check", "effect.lua")
        self.folder = kept

    def test_a_wrong_project_says_why(self):
        for text, says in (
                ('{"assets": ["one", "../x"]}', ["roil.json: a project's assets lie below it; --assets", "leads out"]),
                ('{"assets": ["/etc"]}', "leads out"), ('{"assets": ["none"]}', "assets 'none': there is no such folder"),
                ('{"assets": "one"}', "'assets' is a list"), ('{"asets": []}', "unknown key 'asets'; accepted: assets"),
                ("[]", "an object is accepted"), ('{"assets": ["one"]\n\n', "roil.json:"), ("{" * 100000, "roil.json")):
            self.write("roil.json", text)
            self.fails(1, says, "check", "show/effect.lua")
        os.symlink("/etc", self.path("etc"))
        self.write("roil.json", '{"assets": ["etc"]}')
        self.fails(1, "leads out", "check", "show/effect.lua")

    def test_its_own_folder_counts_first(self):
        self.write("show/tint.lua", 'error "own"')
        self.check(1, "--assets", "one", "--assets", "two", says="own")
        os.remove(self.path("show/tint.lua"))
        self.write("one/tint.lua", 'error "first"')
        self.check(1, "--assets", "one", "--assets", "two", says="one/tint.lua:1: first")
        self.check(0, "--assets", "two", "--assets", "one")

    def test_nothing_else_can_be_read(self):
        self.write("secret.obj", self.read("ground.obj"))
        os.symlink("../secret.obj", self.path("one/link.obj"))
        self.write("one/out.obj", "mtllib ../secret.mtl\n" + self.read("ground.obj").decode())
        for name in ("../secret.obj", self.path("secret.obj"), self.path("one/tent.obj"), "one/../../secret.obj", "link.obj"):
            self.write("show/effect.lua", EFFECT.replace("tent.obj", name))
            self.check(1, "--assets", "one", "--assets", "two")
        self.write("show/effect.lua", EFFECT.replace("tent.obj", "../secret.obj"))
        said = self.check(1, "--assets", "one", "--assets", "two", says="../secret.obj: leads out of")
        self.assertIn("--assets DIR", said)
        self.write("show/effect.lua", 'require "../two/tint"')
        self.check(1, "--assets", "two", says="bad module name")
        self.write("two/haze.comp", HAZE.replace("gain.glsl", "../secret.obj"))
        self.write("show/effect.lua", EFFECT)
        self.check(1, "--assets", "one", "--assets", "two", says="../secret.obj")


if __name__ == "__main__":
    main()
