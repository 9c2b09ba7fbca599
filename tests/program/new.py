"""`roil new` makes folders that need nothing else, and `roil info effects` shows what there is to begin with."""
import base64
import glob
import json
import os
import re

from lib.program import SMALL, SOURCE, Case, main


def shipped():
    return sorted(os.path.splitext(os.path.basename(path))[0] for path in glob.glob(os.path.join(SOURCE, "effects/*.lua")))


class New(Case):
    def test_it_draws(self):
        said = self.succeeds("new", "my-fire")
        self.assertIn("made my-fire/my-fire.lua, with 4 files that it reads", said)
        self.assertIn("roil live my-fire/my-fire.lua", said)
        self.succeeds("new", "burst", "--from", "step-07-data")
        for effect, picture in ("burst/burst.lua", "a.png"), (os.path.join(SOURCE, "effects/step-07-data.lua"), "b.png"):
            self.succeeds("render", effect, "--frames", "30", "-o", picture, *SMALL)
        self.assertIn("PSNR inf", " ".join(self.succeeds("compare", "a.png", "b.png").split()).replace(":", ""))
        settings = json.loads(self.read("my-fire/.luarc.json"))
        self.assertTrue(os.path.exists(self.path("my-fire/" + settings["workspace.library"][0] + "/words.lua")))
        self.assertIn(b"roil render my-fire.lua", self.read("my-fire/my-fire.lua"))

    def test_each_shipped_effect_is_whole_elsewhere(self):
        for name in shipped():
            with self.subTest(name):
                self.succeeds("new", "made-" + name, "--from", name)
                self.succeeds("info", "params", f"made-{name}/made-{name}.lua")  # which reads all its files

    def test_templates_are_those_of_the_start_page(self):
        """Small ones that stand alone, before shipped effects of the same end."""
        for name in ("burst", "smoke", "fire"):
            with self.subTest(name):
                self.assertIn("with 0 files", self.succeeds("new", "my-" + name, "--from", name))
                with open(os.path.join(SOURCE, f"scripts/start/{name}.lua"), "rb") as f:
                    self.assertEqual(self.read(f"my-{name}/my-{name}.lua"), f.read())

    def test_a_choice_brings_its_files(self):
        self.write("a/pick.lua", """
local fx = effect {}
local which = param { "which", "one", words = { "one", "two" } }
local other = param { "other", false }
local name = which:get() == "one" and "one.obj" or "sub/two.obj"
if other:get() then name = "three.obj" end
fx.output = final { shade { from = geometry { mesh { name } } } }.color
return fx
""")
        for name in ("one.obj", "sub/two.obj", "three.obj", "four.obj"):
            self.write("a/" + name, self.read("ground.obj"))
        self.succeeds("new", "b", "--from", "a/pick.lua")
        self.assertEqual(sorted(os.path.relpath(path, self.path("b")) for path in
                                glob.glob(self.path("b/**/*.obj"), recursive=True)), ["one.obj", "sub/two.obj", "three.obj"])

    def test_mistakes(self):
        self.fails(2, "one name is needed", "new")
        self.fails(2, "unknown option '--form'; did you mean '--from'?", "new", "x", "--form", "smoke")
        self.fails(1, "no effect 'smok' comes with roil; did you mean 'smoke'?", "new", "x", "--from", "smok")
        self.fails(1, "`roil info effects` lists them", "new", "x", "--from", "teapot")
        self.fails(1, "none.lua: No such file", "new", "x", "--from", "none.lua")
        self.fails(1, "letters, digits, _ and -", "new", "a b")
        self.assertFalse(os.path.exists(self.path("x")))
        self.write("full/x.txt", "")
        self.fails(1, "full: there is something in it already", "new", "full")
        self.fails(1, "ground.obj", "new", "ground.obj")
        self.write("file", "")
        self.fails(1, "a file of that name is there", "new", "file")

    def test_the_index_has_every_effect_and_its_picture(self):
        text = self.succeeds("info", "effects")
        for name in shipped():
            self.assertRegex(text, rf"(?m)^  {name} ")
        listed = json.loads(self.succeeds("info", "effects", "--json"))["effects"]
        self.assertEqual([one["name"] for one in listed], shipped())
        for one in listed:
            self.assertTrue(one["summary"].endswith((".", ")", ":")) or len(one["summary"]) > 20, one)
            self.assertTrue(os.path.exists(one["picture"]), one)
            if not one["name"].startswith("step-"):  # a lesson is to be short
                with open(one["file"], encoding="utf-8") as file:
                    self.assertIn('author = "the roil authors", licence = "MIT"', file.read(), one)
        self.assertIn("wrote out/index.html", self.succeeds("info", "effects", "-o", "out/index.html"))
        page = self.read("out/index.html").decode()
        pictures = re.findall(r"base64,([A-Za-z0-9+/=]+)\"", page)
        self.assertEqual(len(pictures), len(listed))
        for picture, one in zip(pictures, listed):
            with open(one["picture"], "rb") as file:
                self.assertEqual(base64.b64decode(picture), file.read())
        self.assertNotIn("http", re.sub(r"base64,[^\"]+", "", page))
        self.fails(2, "-o goes with effects", "info", "passes", "-o", "x.html")


if __name__ == "__main__":
    main()
