"""Files that an effect reads: volumes, meshes and shaders, missing, damaged or strange."""
import os
import random
import re
import select
import shutil
import signal
import struct
import subprocess
import time

from lib.pictures import Exr, packed_pixels
from lib.program import CORPUS, DATA, PROGRAM, SECONDS, SMALL, VOLUME, Case, main

VDB = VOLUME % 'vdb { "a.vdb" }.density'
FLOAT = os.path.join(CORPUS, "fuzz_vdb/float.vdb")

# A day of it: some 17 million steps.
WARM = """
local fx = effect { name = "air" }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, warm_up = 86400,
  boundary = "periodic" }
air:source { shape = sphere { radius = 0.3 }, density = 1 }
fx.output = final { march { density = air.density, steps = 4 } }.color
return fx
"""


class Time(Case):
    """What works for a script in other processes takes of the same time."""

    def test_children_count(self):
        self.write("broken.gltf", b"v x")
        self.write("effect.lua", b'local fx = effect { name = "x" }\n'
                                 b"for i = 1, 1e9 do pcall(mesh, {'broken.gltf'}) end\n")
        self.fails(1, ["effect.lua:2:", "time limit of 1 s for a load exceeded", "--time-limit"],
                   "check", "--time-limit", "1", "effect.lua")

    def stop(self, told, *arguments):
        """Interrupts the program, at a terminal, when it has told so of its work; its status, and all it said."""
        ours, terminal = os.openpty()
        job = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=terminal,
                               stderr=terminal)
        os.close(terminal)
        said, end = "", time.monotonic() + SECONDS
        try:
            while job.returncode is None or select.select([ours], [], [], 0)[0]:
                if select.select([ours], [], [], 0.05)[0]:
                    said += os.read(ours, 65536).decode(errors="replace")
                if told and re.search(told, said):
                    job.send_signal(signal.SIGINT)
                    told = None
                self.assertLess(time.monotonic(), end, said)
                job.poll()
        except OSError:  # nobody writes to the terminal any more
            job.wait(SECONDS)
        finally:
            if job.poll() is None:
                job.kill()
                job.wait()
            os.close(ours)
        self.assertIsNone(told, said)
        return job.returncode, said

    def test_long_work_shows_progress_and_stops(self):
        self.write("slow.lua", VOLUME.replace("return fx", "fx:on_frame(function() "
                                              "for i = 1, 1e5 do local x = i end end)\nreturn fx") % "sphere { radius = 1 }")
        self.write("warm.lua", WARM)
        self.write("sweep.lua", 'return sweep { name = "try", effect = "warm.lua", size = {32, 18}, frames = "3",\n'
                   'settle = 0, axes = { axis { "march.steps", 8 } } }')
        of_steps = r"of \d+ steps"
        for arguments, told, says in (
                (["render", "slow.lua", "--frames", "999999", "-o", "a.png"], of_steps, "stopped after"),
                (["render", "warm.lua", "--frames", "1", "-o", "a.png"], of_steps, "stopped after"),
                (["export", "vdb", "warm.lua", "--frames", "1", "-o", "a.vdb"], of_steps, "stopped after"),
                (["bench", "sweep.lua", "-o", "swept"], of_steps, "interrupted"),
                (["tune", "warm.lua", "--axes", "march.steps=4:8", "--max-error", "1", "--frames", "1", "-o", "tuned",
                  *SMALL], of_steps, "")):
            with self.subTest(arguments):
                status, said = self.stop(told, *arguments)
                self.assertEqual(status, 1, said)
                self.assertIn(says, said)
                self.assertFalse(os.path.exists(self.path(arguments[-1])) and arguments[-1].startswith("a."))

    def test_a_large_sequence_shows_progress_and_stops(self):
        self.write("frames.lua", VOLUME % 'vdb { "frames/*.vdb" }.density')
        os.mkdir(self.path("frames"))
        shutil.copy(os.path.join(DATA, "nan.vdb"), self.path("frames/x.vdb"))
        for i in range(9999):
            os.link(self.path("frames/x.vdb"), self.path(f"frames/{i}.vdb"))
        for arguments in (["check", "frames.lua"], ["info", "params", "frames.lua"], ["render", "frames.lua"],
                          ["export", "vdb", "frames.lua", "-o", "%d.vdb"]):
            with self.subTest(arguments):
                self.assertEqual(self.stop(r"of 10000 files", *arguments)[0], -signal.SIGINT)
        self.assertEqual(self.stop(r"of 20000 frames", "export", "raw", "frames/*.vdb", "-o", "a.raw")[0], -signal.SIGINT)
        self.assertFalse(os.path.exists(self.path("a.raw")))


class Volumes(Case):
    def copy(self, source, name="a.vdb"):
        shutil.copy(source, self.path(name))

    def test_missing_file(self):
        self.refuses(VDB, ["effect.lua:4:", "a.vdb"])
        self.refuses(VOLUME % 'vdb { "none/a.vdb" }.density', "none/a.vdb")

    def test_empty_glob(self):
        self.refuses(VOLUME % 'vdb { "data/*.vdb" }.density', ["effect.lua:4:", "data/*.vdb"])
        os.makedirs(self.path("data"))
        self.refuses(VOLUME % 'vdb { "data/*.vdb" }.density', ["effect.lua:4:", "data/*.vdb"])

    def test_truncated_file(self):
        with open(FLOAT, "rb") as f:
            whole = f.read()
        for size in (0, 1, 8, 100, 300, len(whole) // 2, len(whole) - 20):
            with self.subTest(size):
                self.write("a.vdb", whole[:size])
                done = self.run_program("info", "a.vdb")
                self.assertIn(done.returncode, (0, 1))
                self.cannot_draw(VDB, "a.vdb")

    def test_random_bytes(self):
        noise = random.Random(1)
        for beginning in (b"", b"\x20\x42\x44\x56\0\0\0\0" + struct.pack("<I", 224)):
            self.write("a.vdb", beginning + noise.randbytes(5000))
            self.fails(1, "a.vdb", "info", "a.vdb")
            self.refuses(VDB, ["effect.lua:4:", "a.vdb"])

    def test_grid_that_is_not_there(self):
        self.copy(FLOAT)
        self.refuses(VOLUME % 'vdb { "a.vdb" }.heat', ["effect.lua:4:", "heat", "density"])
        self.refuses(VOLUME % 'vdb { "a.vdb" }.densty', ["densty", "density"])

    def test_grid_of_a_type_that_cannot_be_read(self):
        self.copy(os.path.join(CORPUS, "fuzz_vdb/points.vdb"))
        self.refuses(VOLUME % 'vdb { "a.vdb" }.points', ["effect.lua:4:", "a.vdb", "no grid that can be read in this file: points (has values of type"])

    def test_not_a_number_and_infinity_draw_as_finite_pixels(self):
        self.copy(os.path.join(DATA, "nan.vdb"))
        for output in ("physical", "paper"):
            self.render(VDB, "--set", f"march.mode={output}", "--float", output="out.exr")
            picture = Exr(self.read("out.exr"))
            for name, values in picture.channels.items():
                self.assertTrue(all(abs(v) < 1e6 for v in values), name)
            self.assertGreater(max(picture.channels["A"]), 0.1)

    def test_absurd_boxes(self):
        for name in ("far", "wide"):
            self.copy(os.path.join(CORPUS, f"fuzz_vdb/{name}.vdb"))
            self.refuses(VOLUME % f'vdb {{ "a.vdb" }}.{name}', ["effect.lua:4:", "impossible active box"])

    def test_empty_grid_draws_nothing(self):
        self.copy(os.path.join(CORPUS, "fuzz_vdb/empty.vdb"))
        self.write("effect.lua", VOLUME % 'vdb { "a.vdb" }.empty')
        done = self.run_program("render", "effect.lua", "--frames", "1", "-o", "out.exr", "--size", "8x8")
        if done.returncode == 0:
            self.assertEqual(max(Exr(self.read("out.exr")).channels["A"]), 0)
        else:
            self.assertIn("empty", done.stderr)

    def test_link_that_leads_out(self):
        os.makedirs(self.path("inner/data"))
        self.copy(FLOAT)
        self.write("inner/effect.lua", VDB)
        os.symlink("../a.vdb", self.path("inner/a.vdb"))
        self.fails(1, ["effect.lua:4:", "leads out"], "check", "inner/effect.lua")
        os.symlink("../../a.vdb", self.path("inner/data/a.vdb"))
        self.write("inner/effect.lua", VOLUME % 'vdb { "data/*.vdb" }.density')
        self.fails(1, ["effect.lua:4:", "leads out"], "check", "inner/effect.lua")

    def test_folder_that_looks_like_a_pattern(self):
        os.makedirs(self.path("[old] *"))
        self.copy(FLOAT, "[old] */a.vdb")
        self.write("[old] */effect.lua", VOLUME % 'vdb { "*.vdb" }.density')
        self.succeeds("check", "[old] */effect.lua")

    def test_raw_file(self):
        raw = VOLUME % 'raw { "a.raw", type = "u8", size = {8, 8, 8}%s }.density'
        self.refuses(raw % "", ["effect.lua:4:", "a.raw"])
        self.write("a.raw", b"\xff" * 511)
        self.refuses(raw % "", ["effect.lua:4:", "a.raw"])
        self.write("a.raw", b"\xff" * 1024)
        self.render(raw % "")
        self.refuses(raw % ", frames = 3", ["effect.lua:4:", "a.raw"])
        self.refuses(raw % ", skip = 1000", ["effect.lua:4:", "a.raw"])
        self.refuses(VOLUME % 'raw { "a.raw", type = "u7", size = {8, 8, 8} }.density', ["effect.lua:4:", "u7", "did you mean 'u8'?"])
        self.refuses(VOLUME % 'raw { "a.raw", size = {4096, 4096, 4096} }.density', "a.raw")


class Meshes(Case):
    EFFECT = """local fx = effect { name = "mesh" }
fx.output = geometry { mesh { "%s" } }
"""

    def refused(self, name, content, says):
        self.write(name, content)
        self.refuses(self.EFFECT % name, ["effect.lua:2:", name, *says])

    def test_missing_file(self):
        self.refuses(self.EFFECT % "none.obj", ["effect.lua:2:", "none.obj"])

    def test_mesh_without_faces(self):
        self.refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ["face"])

    def test_damaged_files(self):
        self.refused("a.obj", b"\0\xff" * 500, [])
        self.refused("a.gltf", "{", [])
        self.refused("a.glb", b"glTF\2\0\0\0\xff\xff\xff\x7f", [])
        self.refused("a.obj", "v 0 0 0\nf 1 2 999999999\n", [])

    def test_unknown_kind_of_file(self):
        self.refused("a.blend", "BLENDER", [".obj"])


SHADER = """// a test
uniform sampler2D source; //= input : any picture
layout(rgba16f) writeonly uniform image2D color; //= output rgba16f : it, dimmed
uniform float strength; //= 0.5 [0, 1] : how much
#include "half.glsl"
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(color, at, half_of(texelFetch(source, at, 0)) * strength);
}
"""


class Shaders(Case):
    EFFECT = """local fx = effect { name = "shader" }; fx.camera = orbit { distance = 9, pitch = 30 }
fx.output = shader { "dim.comp", geometry { mesh "ground.obj" }.albedo%s }.color
"""

    def setUp(self):
        super().setUp()
        self.write("half.glsl", "vec4 half_of(vec4 v) {\n    return v * 0.5;\n}\n")
        self.write("dim.comp", SHADER)

    def test_shader_of_ones_own_is_a_pass(self):
        self.render(self.EFFECT % ", strength = 1")
        bright = packed_pixels(self.read("out.png"))
        self.render(self.EFFECT % ", strength = 1", "--set", "dim.strength=0.1")
        self.assertNotEqual(packed_pixels(self.read("out.png")), bright)
        self.assertIn("strength", self.succeeds("info", "params", "effect.lua"))

    def test_syntax_error_names_the_real_line(self):
        self.write("dim.comp", SHADER.replace("ivec2 at =", "ivec2 at = ="))
        self.refuses(self.EFFECT % "", "dim.comp:7:")
        self.cannot_draw(self.EFFECT % "", "dim.comp:7:")

    def test_error_in_an_included_file_names_that_file(self):
        self.write("half.glsl", "vec4 half_of(vec4 v) {\n    return v * halff;\n}\n")
        self.refuses(self.EFFECT % "", ["half.glsl:2:", "halff"])

    def test_missing_files(self):
        os.remove(self.path("half.glsl"))
        self.refuses(self.EFFECT % "", ["dim.comp:5:", "half.glsl"])
        os.remove(self.path("dim.comp"))
        self.refuses(self.EFFECT % "", ["effect.lua:2:", "dim.comp"])

    def test_uniforms_are_checked(self):
        self.refuses(self.EFFECT % ", strength = 2", ["effect.lua:2:", "strength", "0", "1"])
        self.refuses(self.EFFECT % ", strength = {1, 2}", ["effect.lua:2:", "strength"])
        self.refuses(self.EFFECT % ', strength = "much"', ["effect.lua:2:", "strength"])
        self.refuses(self.EFFECT % ", strenght = 1", ["effect.lua:2:", "did you mean 'strength'?"])


if __name__ == "__main__":
    main()
