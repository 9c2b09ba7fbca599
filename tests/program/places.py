"""Where the program runs: other devices, none at all, a copied tree, a foreign folder."""
import os
import shutil
import stat

from lib.program import PROGRAM, PUFF, SMALL, SOURCE, Case, main


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
        """Program, shaders, scripts, and one effect, as someone may pack them."""
        for name in ("shaders", "scripts"):
            shutil.copytree(os.path.join(SOURCE, name), self.path(f"copy/{name}"))
        shutil.copy(PROGRAM, self.path("copy/roil"))
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


if __name__ == "__main__":
    main()
