"""Where the program runs: other devices, none at all, a copied tree, a foreign folder."""
import os
import re
import resource
import shlex
import shutil
import stat
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

from lib.program import CORPUS, DATA, GROUND, PROGRAM, PUFF, SECONDS, SMALL, SOURCE, VOLUME, Case, main


class Devices(Case):
    def test_no_device(self):
        none = {"VK_DRIVER_FILES": "/nowhere.json", "VK_ICD_FILENAMES": "/nowhere.json"}
        self.write("puff.lua", PUFF)
        message = self.fails(1, "Vulkan", "render", "puff.lua", "--frames", "1", "-o", "out.png", *SMALL,
                             environment=none)
        self.assertIn("driver", message)  # what to do about it
        self.assertFalse(os.path.exists(self.path("out.png")))
        self.assertIn("good", self.succeeds("check", "puff.lua", environment=none))
        self.assertIn("march", self.succeeds("info", "passes", environment=none))
        done = self.run_program("info", "device", environment=none)
        self.assertIn("Vulkan", done.stdout + done.stderr)

    def test_device_is_chosen_by_name_or_number(self):
        self.write("puff.lua", PUFF)
        name = self.succeeds("info", "device").split("\n")[0].split("  ", 1)[1].rsplit(" (", 1)[0]
        for device in ("0", name, name[:5].upper()):
            out = self.succeeds("render", "puff.lua", "--frames", "1", "-o", "out.png", *SMALL,
                                "--device", device)
            self.assertIn(name, out)

    def test_unknown_device(self):
        self.write("puff.lua", PUFF)
        for device in ("99", "Voodoo", "-1"):
            with self.subTest(device):
                self.fails(1, "device", "render", "puff.lua", "--frames", "1", "-o", "out.png", *SMALL,
                           "--device", device)


class Trees(Case):
    def copy_tree(self):
        """Program, its reader, shaders, scripts, and one effect, as someone may pack them."""
        for name in ("shaders", "scripts"):
            shutil.copytree(os.path.join(SOURCE, name), self.path(f"copy/{name}"))
        shutil.copy(PROGRAM, self.path("copy/roil"))
        shutil.copy(os.path.join(os.path.dirname(PROGRAM), "roil-reader"), self.path("copy/roil-reader"))
        self.write("copy/effects/puff.lua", PUFF)
        self.write("copy/effects/ground.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n")
        return self.path("copy/roil")

    def test_copied_tree_runs(self):
        program = self.copy_tree()
        self.succeeds("render", "copy/effects/puff.lua", "--frames", "1", "-o", "out.png", *SMALL,
                      program=program, environment={"ROIL_CACHE_DIR": self.path("cache")})
        self.assertTrue(os.path.exists(self.path("out.png")))

    def test_copied_tree_is_used_and_not_the_built_one(self):
        program = self.copy_tree()
        path = self.path("copy/shaders/pass/picture/final.comp")
        with open(path, "a", encoding="utf-8") as f:
            f.write("broken\n")
        self.fails(1, "final.comp", "check", "copy/effects/puff.lua", program=program)

    def test_tree_without_shaders_says_so(self):
        program = self.copy_tree()
        shutil.rmtree(self.path("copy/shaders"))
        self.fails(1, "shaders", "check", "copy/effects/puff.lua", program=program)

    def test_home_is_taken_from_the_environment(self):
        program = self.copy_tree()
        shutil.rmtree(self.path("copy/shaders"))
        self.succeeds("check", "copy/effects/puff.lua", program=program, environment={"ROIL_HOME": SOURCE})
        self.fails(1, "nowhere", "check", "copy/effects/puff.lua", environment={"ROIL_HOME": "/nowhere"})

    def test_effect_finds_its_files_from_anywhere(self):
        self.write("deep/puff.lua", PUFF)
        shutil.move(self.path("ground.obj"), self.path("deep/ground.obj"))
        self.succeeds("check", "deep/puff.lua")
        self.succeeds("check", self.path("deep/puff.lua"))
        os.symlink("deep/puff.lua", self.path("link.lua"))
        done = self.run_program("check", "link.lua")
        self.assertIn(done.returncode, (0, 1))  # the link's folder or the file's: not a crash

    def test_unwritable_cache_is_no_obstacle(self):
        self.write("file", "")
        self.render(PUFF, environment={"ROIL_CACHE_DIR": self.path("file/cache")})
        self.render(PUFF, environment={"ROIL_CACHE_DIR": "", "XDG_CACHE_HOME": "", "HOME": ""})

    def test_spoilt_cache_is_no_obstacle(self):
        cache = {"ROIL_CACHE_DIR": self.path("cache")}
        self.render(PUFF, output="a.png", environment=cache)
        files = [os.path.join(folder, name) for folder, _, found in os.walk(self.path("cache"))
                 for name in found]
        self.assertTrue(files)
        for path in files:
            self.assertFalse(os.stat(path).st_mode & stat.S_IWOTH)
            with open(path, "rb+") as f:
                f.seek(os.path.getsize(path) // 2)
                f.write(b"\xff" * 64)
        self.render(PUFF, output="b.png", environment=cache)
        for path in files:
            os.truncate(path, os.path.getsize(path) // 2)
        self.render(PUFF, output="c.png", environment=cache)
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        self.assertEqual(self.read("a.png"), self.read("c.png"))


PNG = open(os.path.join(CORPUS, "fuzz_picture/rgb.png"), "rb").read()
EXR = open(os.path.join(CORPUS, "fuzz_sky/grey.exr"), "rb").read()
VDB = open(os.path.join(DATA, "nan.vdb"), "rb").read()
COMP = """// Nothing.
writeonly uniform image2D color; //= output rgba8 : picture
void main() { imageStore(color, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }
"""
SHADER = 'local fx = effect { name = "s" }\nfx.output = shader { "%s" }.color\nreturn fx\n'
SKY = 'fx.sky = sky { image = "%s" }\nlocal ball'
MATERIAL = "newmtl a\nmap_Kd %s\n"
GLTF = """{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": 36, "uri": "%s"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
"type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]}"""
TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
SLICES = """local flow = slices { count = 1, size = {32, 32}, height = 2, variation = 0 }
%s
return fx"""
MESH = "mtllib m.mtl\nusemtl a\n" + GROUND

# Kinds of files that an effect names: one that is good, and the files that name it as %s.
READERS = {
    "vdb": ("x.vdb", VDB, {"puff.lua": VOLUME % 'vdb { "%s" }.density'}),
    "vdb frames": ("x*.vdb", VDB, {"puff.lua": VOLUME % 'vdb { "%s" }.density'}),
    "raw": ("x.raw", b"8 voxels", {"puff.lua": VOLUME % 'raw { "%s", size = {2, 2, 2}, type = "u8" }.density'}),
    "mesh": ("x.obj", GROUND, {"puff.lua": PUFF.replace("ground.obj", "%s")}),
    "mesh's materials": ("x.mtl", MATERIAL % "evidence.png",
                         {"puff.lua": PUFF.replace("ground", "m"), "m.obj": MESH.replace("m.mtl", "%s")}),
    "mesh's texture": ("x.png", PNG, {"puff.lua": PUFF.replace("ground.obj", "m.obj"), "m.obj": MESH, "m.mtl": MATERIAL}),
    "mesh's buffer": ("x.bin", TRIANGLE, {"puff.lua": PUFF.replace("ground.obj", "m.gltf"), "m.gltf": GLTF}),
    "texture": ("x.png", PNG,
                {"puff.lua": PUFF.replace('"ground.obj"', '"ground.obj", material = material { texture = "%s" }')}),
    "picture": ("x.png", PNG, {"puff.lua": PUFF.replace("return fx", 'local p = image "%s"\nreturn fx')}),
    "obstacle": ("x.png", PNG, {"puff.lua": PUFF.replace("return fx", SLICES % 'flow:obstacle { image = image "%s" }')}),
    "panorama": ("x.exr", EXR, {"puff.lua": PUFF.replace("local ball", SKY)}),
    "shader": ("x.comp", COMP, {"puff.lua": SHADER}),
    "include": ("x.glsl", "// nothing\n", {"puff.lua": SHADER % "s.comp", "s.comp": '#include "%s"\n' + COMP}),
    "module": ("x.lua", "return 1", {"puff.lua": 'local m = require "%s"\n' + PUFF}),
}
# What is there, in place of the file or on the way to it; and how the effect names it then. Of `in/`, which is the
# effect's folder, beside `outside/`, which has a good file.
WAYS = {
    "inside": lambda case, name: name,
    "link that stays inside": lambda case, name: case.link("in/" + name, "other/" + name, "in/other"),
    "dashes": lambda case, name: "--" + name,
    "up": lambda case, name: "../outside/" + name,
    "up and back": lambda case, name: "../in/../outside/" + name,
    "absolute": lambda case, name: case.path("outside/" + name),
    "link to a file": lambda case, name: case.link("in/" + name, "../outside/" + name),
    "link as a folder": lambda case, name: case.link("in/way", "../outside") and "way/" + name,
    "link to a link": lambda case, name: case.link("in/there", "../outside") and case.link("in/" + name, "there/" + name),
    "pipe": lambda case, name: os.mkfifo(case.path("in/" + name.replace("*", "1"))) or name,
    "device": lambda case, name: case.link("in/" + name, "/dev/zero"),
}
GOOD = "inside", "link that stays inside", "dashes"
# A mesh does without these, and goes on: whether one was read shows in what is said.
WAS_READ = {
    "mesh's materials": lambda said: "evidence.png" in said,
    "mesh's texture": lambda said: "without a texture" not in said,
}

AIR = """
local fx = effect { name = "air" }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2 }
air:source { shape = sphere { radius = 0.3 }, density = 1 }
fx.output = final { march { density = air.density, steps = 4 } }.color
return fx
"""
RENDER = ["render", "air.lua", "--frames", "2", "-o", "out.png", *SMALL]

# Each reads the file x that the user names.
NAMED = {
    "check": ["check", "x"], "info": ["info", "params", "x"], "vdb": ["info", "x.vdb"],
    "raw": ["export", "raw", "x.vdb", "-o", "x.raw"], "restore": RENDER + ["--restore", "x"],
    "from": ["render", "--from", "x", "-o", "out.png"], "compare": ["compare", "x", "x"],
    "sweep": ["bench", "--list", "x"], "baseline": ["bench", "--report", "x"],
}

KEPT = ["0000.png", "0" * 32 + "-0.png", "results.json"]


def with_text(png, key, text):
    """A picture that says something else of itself."""
    at = png.index(b"tEXt" + key) - 4
    chunk = b"tEXt" + key + b"\0" + text
    return (png[:at] + struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
            + png[at + 12 + int.from_bytes(png[at:at + 4], "big"):])


class Confined(Case):
    """What is not named on the command line lies below the effect's folder, or that of results, and is a
    regular file; what is named is one, too, where it is read."""

    def place(self, name, kind):
        """Something at `name` that is not to be read."""
        path = self.path(name)
        if kind == "pipe":
            os.mkfifo(path)
        else:
            os.symlink("/dev/zero", path)

    def link(self, name, target, good=None):
        """A link where a file would be; `good`: the folder of a file that it may lead to."""
        os.symlink(target.replace("*", "1"), self.path(name.replace("*", "1")))
        return os.path.relpath(name, "in")

    def arrange(self, way, name, content, files):
        """What the effect calls the file."""
        shutil.rmtree(self.path("in"), ignore_errors=True)
        file = name.replace("*", "1")
        self.write("in/other/" + file, content)
        self.write("in/ground.obj", GROUND)
        if way in ("inside", "dashes"):
            self.write("in/" + ("--" if way == "dashes" else "") + file, content)
        named = WAYS[way](self, name)
        if name.endswith(".lua"):
            named = named[:-len(".lua")]  # of a module
        for at, text in files.items():
            self.write("in/" + at, text.replace("%s", named))
        return named

    def test_what_an_effect_names_is_a_file_inside(self):
        for reader, (name, content, files) in READERS.items():
            self.write("outside/" + name.replace("*", "1"), content)
            for way in WAYS:
                with self.subTest(reader, way=way):
                    self.arrange(way, name, content, files)
                    begin = time.monotonic()
                    done = self.run_program("check", "in/puff.lua")
                    self.assertLess(time.monotonic() - begin, 60)
                    if reader in WAS_READ and done.returncode == 0:
                        self.assertEqual(WAS_READ[reader](done.stderr), way in GOOD, done.stderr)
                    elif way in GOOD:
                        self.assertEqual(done.returncode, 0, done.stderr)
                    else:
                        self.assertEqual(done.returncode, 1, done.stdout)
                        self.assertRegex(done.stderr, r"roil: .*\bx[1*]?\b")  # the file

    def scripts(self, makes):
        """For each way in which an effect can be named: `makes(name)` has named it."""
        outside = tempfile.mkdtemp(prefix="roil-outside-")
        self.addCleanup(shutil.rmtree, outside)
        for name, content in ("x.lua", PUFF), ("ground.obj", GROUND):
            shutil.copy(self.write(name, content), outside)
        scratch = self.folder
        for way in ("inside", "dashes", "up", "absolute", "link to a file", "link as a folder", "pipe", "device"):
            self.folder = tempfile.mkdtemp(dir=scratch)
            self.write("ground.obj", GROUND)
            name = "--x.lua" if way == "dashes" else "x.lua"
            named = {"up": f"../../{os.path.basename(outside)}/x.lua", "absolute": outside + "/x.lua",
                     "link as a folder": "way/x.lua"}.get(way, name)
            if way in ("inside", "dashes"):
                self.write(name, PUFF)
            elif way == "link as a folder":
                os.symlink(outside, self.path("way"))
            elif way == "pipe":
                os.mkfifo(self.path(name))
            elif way.startswith("link") or way == "device":
                os.symlink("/dev/zero" if way == "device" else outside + "/x.lua", self.path(name))
            with self.subTest(way):
                makes(named)
                yield way
        self.folder = scratch

    def test_the_effect_of_a_recipe_lies_inside(self):
        self.write("x.lua", PUFF)
        self.succeeds("render", "x.lua", "--frames", "1", "-o", "shot.png", *SMALL)
        shot = self.read("shot.png")
        for way in self.scripts(lambda name: self.write("shot.png", with_text(shot, b"roil:effect", name.encode()))):
            done = self.run_program("render", "--from", "shot.png", "-o", "out.png")
            self.assertEqual(done.returncode, 0 if way in GOOD else 1, done.stderr)
            self.assertEqual(os.path.exists(self.path("out.png")), way in GOOD)
            if way not in GOOD:
                self.assertRegex(done.stderr, r"roil: .*(x\.lua|shot\.png)")

    def test_the_effect_of_a_sweep_lies_inside(self):
        for measure in ('frames = "3", settle = 0', 'frames = "3", measure = "start", repeats = 1, '
                        'axes = { axis { "command", "check" } }'):
            def make(name, measure=measure):
                self.write("sweep.lua", 'return sweep { name = "try", effect = "%s", size = {32, 18}, %s }' % (name, measure))
            for way in self.scripts(make):
                done = self.run_program("bench", "sweep.lua", "-o", "out")
                self.assertEqual(done.returncode, 0 if way in GOOD else 1, done.stdout + done.stderr)
                if way not in GOOD:
                    self.assertRegex(done.stdout + done.stderr, r"x\.lua")

    def test_a_reload_copies_no_more_than_links(self):
        self.write("outside/x.png", PNG)
        effect = READERS["texture"][2]["puff.lua"] + "-- edited\n"
        self.write("sweep.lua", 'return sweep { name = "try", effect = "in/puff.lua", size = {32, 18}, frames = "3", '
                   'measure = "reload", repeats = 1, warmup = 0,\n'
                   'axes = { axis { "edit", { name = "a", edit = {"-- edited", "-- again"} } } } }')
        for way in WAYS:
            with self.subTest(way):
                self.arrange(way, "x.png", PNG, {"puff.lua": effect})
                done = self.run_program("bench", "sweep.lua", "-o", "out")
                self.assertEqual(done.returncode, 0 if way in GOOD else 1, done.stdout + done.stderr)
                if way not in GOOD:
                    self.assertIn("x.png", done.stdout + done.stderr)

    def test_what_the_user_names_is_a_file(self):
        self.write("air.lua", AIR)
        for kind in "pipe", "device":
            self.place("x", kind)
            os.symlink("x", self.path("x.vdb"))
            for command, arguments in NAMED.items():
                with self.subTest(command, kind=kind):
                    self.fails(1, "x", *arguments)
            os.unlink(self.path("x"))
            os.unlink(self.path("x.vdb"))

    def results(self):
        """A sweep's results, and what lies beside them that nobody may touch: all that is in keep/."""
        self.write("puff.lua", PUFF)
        self.write("sweep.lua", 'return sweep { name = "try", effect = "puff.lua", size = {32, 18}, frames = "3",\n'
                   'settle = 0, reference = { steps = 64 }, axes = { axis { "steps", 8 } } }')
        for name in KEPT:
            self.write(f"keep/{name}", "kept")

    def assert_kept(self):
        self.assertEqual(sorted(os.listdir(self.path("keep"))), sorted(KEPT))
        for name in KEPT:
            self.assertEqual(self.read(f"keep/{name}"), b"kept", name)

    def test_results_are_written_below_their_folder(self):
        self.results()
        for name in "rows", "reference", "results.json", "results.csv", "report.html", "rows/0000.png":
            for option in [], ["--resume"]:
                with self.subTest(name, option=option):
                    shutil.rmtree(self.path("out"), ignore_errors=True)
                    os.makedirs(os.path.dirname(self.path(f"out/{name}")))
                    os.symlink(self.path("keep") if "." not in name else self.path("keep/0000.png"),
                               self.path(f"out/{name}"))
                    done = self.run_program("bench", "sweep.lua", "-o", "out", *option)
                    self.assert_kept()
                    if name != "rows/0000.png" or option:  # which is a picture of an earlier run, and goes
                        self.assertEqual(done.returncode, 1, done.stderr)

    def test_results_are_read_below_their_folder(self):
        self.results()
        self.succeeds("bench", "sweep.lua", "-o", "good", "--no-reference")
        shutil.copytree(self.path("good"), self.path("bad"))
        os.unlink(self.path("bad/results.json"))
        os.symlink("../good/results.json", self.path("bad/results.json"))
        self.fails(1, "leads out", "bench", "--report", "bad")
        self.fails(1, "leads out", "bench", "--merge", "bad", "-o", "merged")
        shutil.copy(self.path("good/results.json"), self.path("pipe.json"))
        os.unlink(self.path("bad/results.json"))
        shutil.copy(self.path("pipe.json"), self.path("bad/results.json"))
        for target in "../../keep/0000.png", self.path("keep/0000.png"), "/dev/zero", None:
            with self.subTest(target):
                os.unlink(self.path("bad/rows/0000.png"))
                if target:
                    os.symlink(target, self.path("bad/rows/0000.png"))
                else:
                    os.mkfifo(self.path("bad/rows/0000.png"))
                self.fails(1, "rows/0000.png", "bench", "--merge", "bad", "-o", "merged")
                self.assertFalse(os.path.exists(self.path("merged/rows/0000.png")))
        shutil.rmtree(self.path("bad/rows"))
        os.symlink("../good/rows", self.path("bad/rows"))
        self.fails(1, "leads out", "bench", "--merge", "bad", "-o", "merged")
        with open(self.path("bad/results.json"), encoding="utf-8") as f:
            results = f.read()
        for name in "../good/rows/0000.png", self.path("good/rows/0000.png"), "--help", "rows/../../keep/0000.png":
            self.write("bad/results.json", results.replace("rows/0000.png", name))
            self.fails(1, "thumbnail", "bench", "--merge", "bad", "-o", "merged")
        shutil.rmtree(self.path("bad"))
        shutil.copytree(self.path("good"), self.path("bad"))
        os.unlink(self.path("bad/report.html"))
        os.mkfifo(self.path("bad/report.html"))
        self.fails(1, "report.html", "bench", "--report", "bad")

    def test_presets_do_not_lead_out(self):
        self.write("in/puff.lua", PUFF)
        self.write("in/ground.obj", GROUND)
        self.write("out/warm.lua", "return {}\n")
        os.symlink("../out", self.path("in/puff.presets"))
        info = ["info", "params", "in/puff.lua", "--preset"]
        self.fails(1, "leads out", *info, "warm")
        os.unlink(self.path("in/puff.presets"))
        self.write("in/puff.presets/good.lua", "return {}\n")
        self.succeeds(*info, "good")
        os.symlink("good.lua", self.path("in/puff.presets/link.lua"))
        self.succeeds(*info, "link")
        os.symlink("../../out/warm.lua", self.path("in/puff.presets/warm.lua"))
        os.symlink("/dev/zero", self.path("in/puff.presets/device.lua"))
        os.mkfifo(self.path("in/puff.presets/pipe.lua"))
        for name in "warm", "device", "pipe", "../../out/warm", "--help":
            with self.subTest(name):
                self.fails(1, name, *info, name)

    def test_default_outputs_stay_in_the_current_folder(self):
        """An archive of a stranger may bring an `out` that leads elsewhere."""
        self.results()
        outside = tempfile.mkdtemp(prefix="roil-outside-")
        self.addCleanup(shutil.rmtree, outside)
        commands = {
            "puff/0003.png": ["render", "puff.lua", "--frames", "3", *SMALL],
            "bench/sweep": ["bench", "sweep.lua", "--no-reference"],
            "tune/puff": ["tune", "puff.lua", "--axes", "steps=8:4", "--max-error", "1", "--frames", "1", "--repeats", "1",
                          *SMALL],
        }
        for place, command in commands.items():
            for link in "out", os.path.dirname("out/" + place), "out/" + place:
                for target in outside, "/dev/zero", None:
                    with self.subTest(command[0], link=link, target=target):
                        os.makedirs(os.path.dirname(self.path(link)), exist_ok=True)
                        if target:
                            os.symlink(target, self.path(link))
                        else:
                            os.mkfifo(self.path(link))
                        try:
                            self.fails(1, "out", *command)
                            self.assertEqual(os.listdir(outside), [])
                        finally:
                            os.unlink(self.path(link))
            self.succeeds(*command)
            os.rename(self.path("out"), self.path("named"))
            os.symlink("named", self.path("out"))  # one that stays inside
            self.succeeds(*command)
            os.unlink(self.path("out"))
            shutil.rmtree(self.path("named"))

    def test_what_tune_prints_can_be_run(self):
        for name in "two words.lua", "it's.lua", "--puff.lua", "$(touch bad).lua":
            with self.subTest(name):
                self.write(name, PUFF)
                said = self.succeeds("tune", "--axes", "steps=8:4", "--max-error", "1", "--frames", "1", "--repeats", "1",
                                     "-o", "tuned", *SMALL, "--", name)
                command = re.search("wrote the preset: roil (.*)", said)[1]
                self.assertEqual(shlex.split(command), ["render", ("./" if name[0] == "-" else "") + name, "--preset", "tuned"])
                done = subprocess.run(["sh", "-c", f'"{PROGRAM}" {command} --frames 1 -o "{self.path("o.png")}" --size 16x9'],
                                      cwd=self.folder, timeout=SECONDS, check=False, stdout=subprocess.DEVNULL)
                self.assertEqual(done.returncode, 0)
                self.assertFalse(os.path.exists(self.path("bad")))


class Small(Case):
    def assert_plain(self, done):
        for text in done.stdout, done.stderr:
            self.assertNotIn("\x1b", text)
            self.assertNotIn("\x07", text)
            self.assertNotIn("\x9b", text)

    def test_terminals_obey_nothing_of_a_file(self):
        self.write("puff.lua", PUFF.replace('help = "of the smoke"', 'help = "of\\27[31m the smoke\\7"'))
        told = self.run_program("info", "params", "puff.lua")
        self.assertIn("of?[31m the smoke?", told.stdout)
        self.assert_plain(told)
        self.write("sweep.lua", 'return sweep { name = "try", title = "a", effect = "puff.lua", size = {32, 18},\n'
                   'frames = "3", settle = 0, axes = { axis { "at", { name = "=b\\194\\155[3J", steps = 8 } } } }')
        told = self.run_program("bench", "sweep.lua", "-o", "out")
        self.assertIn("b??[3J", told.stdout)
        self.assert_plain(told)
        self.assert_plain(self.run_program("bench", "--list", "sweep.lua"))
        self.assertNotRegex(self.read("out/results.csv").decode(), '(?m)(^|[,"])=')  # which a table would calculate

    def test_terminals_obey_no_grid(self):
        for name in b"a\x1b[31m\x07", b"\xc2\x9b31m\r\n", b"\x1b]0;a\x07":
            with self.subTest(name):
                self.write("a.vdb", VDB.replace(b"density", (name + b"       ")[:7]))
                self.write("volume.lua", VOLUME % 'vdb { "a.vdb" }.density')
                told = self.run_program("info", "a.vdb")
                self.assertIn("?", told.stdout)
                self.assert_plain(told)
                for arguments in ["check", "volume.lua"], ["export", "raw", "a.vdb", "-o", "a.raw"]:
                    told = self.run_program(*arguments)
                    self.assertEqual(told.returncode, 1)
                    self.assert_plain(told)

    def test_terminals_obey_no_recipe(self):
        self.write("puff.lua", PUFF)
        self.succeeds("render", "puff.lua", "--frames", "1", "-o", "shot.png", "--set", "steps=9", *SMALL)
        shot = self.read("shot.png")
        for key, text in ((b"effect", b"a\x1b[31m.lua"), (b"frame", b"1\x1b[31m"), (b"size", b"9x\x1b[31m9"),
                          (b"settings", b"ste\x1b[31mps=9\n"), (b"settings", b"steps=\x1b[31m9\n"),
                          (b"settings", b"look=\x9b31m\x07\n"), (b"settings", b"st\x1b[31meps\n")):
            with self.subTest(key, text=text):
                self.write("shot.png", with_text(shot, b"roil:" + key, text))
                told = self.run_program("render", "--from", "shot.png", "-o", "out.png")
                self.assertEqual(told.returncode, 1, told.stdout)
                self.assert_plain(told)

    def test_standard_streams_may_be_closed(self):
        self.write("puff.lua", PUFF)
        self.render(PUFF, output="a.png")

        def close():
            for number in 0, 1, 2:
                os.close(number)

        done = subprocess.run([PROGRAM, "render", "effect.lua", "--frames", "1", "-o", "b.png", *SMALL], cwd=self.folder,
                              preexec_fn=close, timeout=60, check=False)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.read("a.png"), self.read("b.png"))

    @unittest.skipUnless(os.geteuid() == 0, "takes the place of a user who runs nothing else")
    def test_threads_that_cannot_be_made_are_a_message(self):
        shutil.copy(os.path.join(DATA, "nan.vdb"), self.path("a.vdb"))
        os.chmod(self.folder, 0o777)
        self.write("puff.lua", PUFF)
        self.write("volume.lua", VOLUME % 'vdb { "a.vdb", storage = "sparse" }.density')
        commands = (["check", "puff.lua"], ["check", "volume.lua"], ["export", "raw", "a.vdb", "-o", "a.raw"],
                    ["render", "volume.lua", "--frames", "1", "-o", "a.png", *SMALL])
        user = 41000  # another one each time: processes that just end count, too
        for number in 5, 8, 12:  # below 5 a library that OpenVDB needs ends the program before it begins
            for arguments in commands:
                user += 1

                def limit(user=user, number=number):
                    os.setgid(user)
                    os.setuid(user)
                    resource.setrlimit(resource.RLIMIT_NPROC, (number, number))

                with self.subTest(arguments, threads=number):
                    done = self.run_program(*arguments, before=limit, environment={"ROIL_CACHE_DIR": self.path("cache")})
                    messages = [line for line in done.stderr.splitlines() if line.startswith("roil: ")]
                    self.assertIn((done.returncode, len(messages)), ((0, 0), (1, 1)), done.stderr)

    def test_presets_are_not_written_elsewhere(self):
        self.write("in/puff.lua", PUFF)
        self.write("in/ground.obj", GROUND)
        os.mkdir(self.path("out"))
        os.symlink("../out", self.path("in/puff.presets"))
        message = self.fails(1, "leads out", "tune", "in/puff.lua", "--axes", "steps=8:4", "--max-error", "1", "--frames", "1",
                             "--repeats", "1", "-o", "tuned", *SMALL)
        self.assertNotIn("wrote the preset", message)
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_names_that_begin_with_dashes_are_names(self):
        self.write("--help.lua", PUFF)
        self.assertIn("good", self.succeeds("check", "--", "--help.lua"))
        self.assertIn("good", self.succeeds("check", "./--help.lua"))
        self.write("sweep.lua", 'return sweep { name = "a", effect = "--help.lua", measure = "start", command = "check",\n'
                   'repeats = 1, axes = { axis { "at", { name = "b" } } } }')
        self.succeeds("bench", "sweep.lua", "-o", "out")
        self.assertIn("b", self.read("out/results.csv").decode())

    def test_full_standard_output_is_a_failure(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            self.assertEqual(subprocess.run([PROGRAM, "--version"], stdout=full, check=False).returncode, 1)


if __name__ == "__main__":
    main()
