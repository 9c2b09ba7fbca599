"""Where the program runs: other devices, none at all, a copied tree, a foreign folder."""
import os
import resource
import shutil
import stat
import subprocess
import unittest

from lib.program import DATA, GROUND, PROGRAM, PUFF, SMALL, SOURCE, VOLUME, Case, main


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
        path = self.path("copy/shaders/pass/final.comp")
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


# Each reads the file NAME that its effect names: the end of an effect, made so that only the file fails.
READERS = {
    "vdb": ("x.vdb", VOLUME % 'vdb { "%s" }.density'),
    "vdb frames": ("x1.vdb", (VOLUME % 'vdb { "%s" }.density').replace("%s", "x*.vdb")),
    "raw": ("x.raw", VOLUME % 'raw { "%s", size = {2, 2, 2}, type = "u8" }.density'),
    "mesh": ("x.obj", PUFF.replace("ground.obj", "%s")),
    "texture": ("x.png", PUFF.replace('"ground.obj"', '"ground.obj", material = material { texture = "%s" }')),
    "panorama": ("x.exr", PUFF.replace("local ball", 'fx.sky = sky { image = "%s" }\nlocal ball')),
    "shader": ("x.comp", 'local fx = effect { name = "s" }\nfx.output = shader { "%s" }.color\nreturn fx\n'),
    "module": ("x.lua", 'local m = require "x"\n' + PUFF),
}

AIR = """
local fx = effect { name = "air" }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, collision = "bgk", viscosity = 0.01 }
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


class Confined(Case):
    """What is not named on the command line lies below the effect's folder, or that of results, and is a
    regular file; what is named is one, too, where it is read."""

    def place(self, name, kind):
        """Something at `name` that is not to be read."""
        path = self.path(name)
        if kind == "pipe":
            os.mkfifo(path)
        else:
            target = {"device": "/dev/zero", "link": self.path("secret"), "pipe out": self.path("pipe")}[kind]
            os.symlink(target, path)

    def test_what_an_effect_names_is_a_file_inside(self):
        self.write("secret", b"secret" * 99)
        for reader, (name, effect) in READERS.items():
            for kind in "pipe", "device", "link":
                with self.subTest(reader, kind=kind):
                    path = self.path(f"{reader}-{kind}")
                    self.write(f"{reader}-{kind}/puff.lua", effect.replace("%s", name))
                    self.write(f"{reader}-{kind}/ground.obj", GROUND)
                    self.place(f"{reader}-{kind}/{name}", kind)
                    says = name if kind == "pipe" else "out"
                    message = self.fails(1, says, "check", os.path.join(path, "puff.lua"))
                    self.assertNotIn("secretsecret", message)

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
        os.unlink(self.path("bad/rows/0000.png"))
        os.symlink("../../keep/0000.png", self.path("bad/rows/0000.png"))
        self.fails(1, "leads out", "bench", "--merge", "bad", "-o", "merged")
        os.unlink(self.path("bad/report.html"))
        os.mkfifo(self.path("bad/report.html"))
        self.fails(1, "report.html", "bench", "--report", "bad")

    def test_presets_do_not_lead_out(self):
        self.write("in/puff.lua", PUFF)
        self.write("out/warm.lua", "return {}\n")
        os.symlink("../out", self.path("in/puff.presets"))
        self.fails(1, "leads out", "info", "params", "in/puff.lua", "--preset", "warm")


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
