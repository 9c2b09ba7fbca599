"""Bundles: one file with all that an effect reads, which draws the same anywhere; and those of strangers."""
import glob
import io
import json
import os
import shutil
import signal
import subprocess
import tarfile
import tempfile

from assets import EFFECT, HAZE
from lib.pictures import packed_pixels
from lib.program import CORPUS, PROGRAM, PUFF, SMALL, Case, main

RIGHTS = 'name = "assets", author = "Ada Example", licence = "CC BY 4.0"'
LIBRARY = 'local spread = require "spread"\n'  # of the program, which is not packed


def archive(entries, form=tarfile.USTAR_FORMAT):
    """A tar file of names with their content, or with what they link to."""
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w", format=form) as tar:
        for name, content in entries:
            info = tarfile.TarInfo(name)
            if content is None:
                info.type = tarfile.DIRTYPE
            elif isinstance(content, tuple):
                info.type, info.linkname = content
            else:
                info.size = len(content)
            tar.addfile(info, io.BytesIO(content if isinstance(content, bytes) else b""))
    return out.getvalue()


class Bundle(Case):
    def setUp(self):
        super().setUp()
        self.cache = tempfile.mkdtemp(prefix="roil-cache-")
        self.addCleanup(shutil.rmtree, self.cache)
        shared = os.environ["ROIL_CACHE_DIR"]  # its compiled shaders are used, its bundles are others'
        for name in os.listdir(shared) if os.path.isdir(shared) else []:
            if name != "bundles":
                os.symlink(os.path.join(shared, name), os.path.join(self.cache, name))

    def run_program(self, *args, environment=None, **options):
        return super().run_program(*args, environment={"ROIL_CACHE_DIR": self.cache, **(environment or {})}, **options)

    def left(self):
        return glob.glob(self.cache + "/bundles/*")

    def write_all(self):
        self.write("show/effect.lua", LIBRARY + EFFECT.replace('name = "assets"', RIGHTS))
        self.write("show/effect.presets/thin.lua", 'return { ["march.steps"] = 2 }')
        self.write("show/other.lua", "return nothing")
        self.write("one/tent.obj", self.read("ground.obj"))
        self.write("one/grids/a1.vdb", "")
        shutil.copy(os.path.join(CORPUS, "fuzz_vdb/float.vdb"), self.path("one/grids/a1.vdb"))
        self.write("two/tint.lua", "return 2")
        self.write("two/haze.comp", HAZE)
        self.write("two/gain.glsl", "#define GAIN 1.0\n")
        return ["--assets", "one", "--assets", "two"]

    def recipe(self, name):
        raw = self.read(name)
        return json.JSONDecoder().raw_decode(raw[raw.index(b'{"roil-recipe":1,'):].decode("latin-1"))[0]

    def test_it_draws_the_same_elsewhere(self):
        folders = self.write_all()
        self.succeeds("render", "show/effect.lua", "--frames", "1", "-o", "here.png", *SMALL, *folders)
        self.succeeds("render", "show/effect.lua", "--frames", "1", "-o", "thin.png", "--preset", "thin", *SMALL, *folders)
        said = self.succeeds("bundle", "show/effect.lua", "-o", "given/show.roil", *folders)
        self.assertRegex(said, r"wrote given/show.roil: 7 files, [1-9][0-9.]* kB\.")
        self.succeeds("bundle", "show/effect.lua", "-o", "again.roil", *folders)
        self.assertEqual(self.read("given/show.roil"), self.read("again.roil"))
        here, self.folder = self.folder, tempfile.mkdtemp(prefix="roil-empty-")
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.move(os.path.join(here, "given/show.roil"), self.path("gift.roil"))
        for name in ("show", "one", "two"):
            shutil.rmtree(os.path.join(here, name))
        self.succeeds("render", "gift.roil", "--frames", "1", "-o", "here.png", *SMALL)
        self.succeeds("render", "gift.roil", "--frames", "1", "-o", "thin.png", "--preset", "thin", *SMALL)
        there = {name: packed_pixels(self.read(name)) for name in ("here.png", "thin.png")}
        inputs = self.recipe("here.png")
        self.assertEqual(inputs["effect"], "gift.roil")
        self.assertIn("the same, bit for bit", self.succeeds("repro", "here.png"))
        self.folder, away = here, self.folder
        for name, pixels in there.items():
            self.assertEqual(packed_pixels(self.read(name)), pixels, name)
        self.assertNotEqual(there["here.png"], there["thin.png"])
        self.assertEqual(self.recipe("here.png")["inputs"], inputs["inputs"])
        self.folder = away
        self.succeeds("check", "gift.roil")
        self.succeeds("export", "vdb", "gift.roil", "-o", "v.vdb", "--frames", "1", "--size", "8")
        self.write("sweep.lua", 'return sweep { name = "s", effect = "gift.roil", size = {32, 18}, frames = "1", repeats = 1 }')
        self.succeeds("bench", "sweep.lua", "-o", "bench")
        self.assertEqual(self.left(), [])

    def test_whose_it_is(self):
        folders = self.write_all()
        self.succeeds("bundle", "show/effect.lua", "-o", "x.roil", *folders)
        for file in (["x.roil"], ["show/effect.lua", *folders]):
            text = self.succeeds("info", *file)
            self.assertIn("author: Ada Example\nlicence: CC BY 4.0\nreads 7 files", text)
            about = json.loads(self.succeeds("info", *file, "--json"))
            self.assertEqual((about["effect"]["author"], about["effect"]["licence"]), ("Ada Example", "CC BY 4.0"))
            self.assertEqual([one["name"] for one in about["files"]], [
                "effect.lua", "effect.presets/thin.lua", "gain.glsl", "grids/a1.vdb", "haze.comp", "tent.obj", "tint.lua"])
        params = json.loads(self.succeeds("info", "params", "x.roil", "--json"))
        self.assertEqual(params["effect"]["licence"], "CC BY 4.0")
        self.refuses(PUFF.replace('name = "puff"', 'author = "two\\nlines"'), "'author' takes one line")
        self.refuses(PUFF.replace('name = "puff"', 'licence = ""'), "'licence' takes one line")
        self.write("puff.lua", PUFF)
        done = self.run_program("bundle", "puff.lua")
        self.assertIn("puff.lua does not say its author and licence", done.stderr)
        self.assertTrue(os.path.exists(self.path("puff.roil")))

    def test_any_tar_unpacks_and_packs_it(self):
        self.write("puff.lua", PUFF)
        self.succeeds("bundle", "puff.lua", "-o", "a.roil")
        subprocess.run(["tar", "-xf", "a.roil"], cwd=self.folder, check=True)
        self.assertEqual(self.read("puff/puff.lua").decode(), PUFF)
        subprocess.run(["tar", "-cf", "b.roil", "puff"], cwd=self.folder, check=True)
        subprocess.run(["tar", "--format=ustar", "-cf", "c.roil", "puff"], cwd=self.folder, check=True)
        self.succeeds("check", "b.roil", "c.roil")
        self.succeeds("new", "mine", "--from", "a.roil")
        self.assertEqual(self.read("mine/mine.lua").decode(), PUFF)
        self.succeeds("check", "mine/mine.lua")

    def test_messages_name_the_bundle(self):
        self.write("bad.roil", archive([("bad/bad.lua", b"local x = require 'part'\n"), ("bad/part.lua", b"\nerror 'no'\n")]))
        self.fails(1, "roil: bad.roil/part.lua:2: no", "check", "bad.roil")
        errors = json.loads(self.run_program("check", "bad.roil", "--json").stdout)["errors"]
        self.assertEqual((errors[0]["file"], errors[0]["line"]), ("bad.roil/part.lua", 2))
        effect = PUFF.replace("ground.obj", "none.obj").encode()
        self.write("mesh.roil", archive([("mesh/mesh.lua", effect)]))
        message = self.fails(1, "mesh.roil/mesh.lua:7:", "check", "mesh.roil")
        self.assertNotIn(self.cache, message)

    def test_a_bundle_reads_nothing_else(self):
        self.write("one/ground.obj", self.read("ground.obj"))
        self.write("x.roil", archive([("x/x.lua", PUFF.encode()), ("x/roil.json", b'{"assets": ["../../.."]}')]))
        self.fails(1, "ground.obj", "check", "x.roil", "--assets", "one", environment={"ROIL_ASSETS": "one"})

    def test_what_strangers_send(self):
        lua, ground = ("x/x.lua", PUFF.encode()), ("x/ground.obj", self.read("ground.obj"))
        self.write("good.roil", archive([("x", None), lua, ground]))
        self.succeeds("check", "good.roil")
        whole = self.read("good.roil")
        damaged = bytearray(whole)
        damaged[600] ^= 1
        pax = archive([lua, ("x/" + "l" * 120, b"x")], tarfile.PAX_FORMAT)
        for content, says in (
                (archive([lua, ("x/../y.lua", b"x")]), "can be no name of a file"),
                (archive([lua, ("/etc/x", b"x")]), "can be no name of a file"),
                (archive([lua, ("../x", b"x")]), "can be no name of a file"),
                (archive([lua, ("x/a\nb", b"x")]), "can be no name of a file"),
                (archive([lua, ("y/a", b"x")]), "does not lie in its folder 'x'"),
                (archive([lua, ("xy/a", b"x")]), "does not lie in its folder 'x'"),
                (archive([("x.lua", PUFF.encode())]), "does not lie in a folder"),
                (archive([lua, ground, ground]), "'ground.obj' is in it twice"),
                (archive([lua, ("x/ground.obj", (tarfile.SYMTYPE, "/etc/passwd"))]), "an entry of type '2'"),
                (archive([lua, ("x/ground.obj", (tarfile.LNKTYPE, "x/x.lua"))]), "an entry of type '1'"),
                (archive([lua, ("x/ground.obj", (tarfile.FIFOTYPE, ""))]), "an entry of type '6'"),
                (archive([lua, ("x/ground.obj/a", b"x"), ground]), "cannot be unpacked"),
                (archive([("x/y.lua", PUFF.encode())]), "there is no effect 'x.lua' in it"),
                (archive([(f"x/{i}", b"") for i in range(65537)]), "more than 65536 files"),
                (pax, "plain files and folders are accepted"), (archive([]), "there is no file in it"),
                (whole[:1500], "it ends too early"), (whole[:700], "it ends too early"), (b"", "it ends too early"),
                (bytes(damaged), None), (b"PK\3\4" + bytes(1000), "it is no bundle"), (b"\0" * 100, "it ends too early")):
            self.write("bad.roil", content)
            if says is None:
                self.run_program("check", "bad.roil")
            else:
                self.fails(1, ["bad.roil: ", says], "check", "bad.roil")
        self.assertEqual(self.left(), [])
        self.assertEqual(sorted(os.listdir(self.folder)), ["bad.roil", "good.roil", "ground.obj"])

    def test_what_cannot_be_packed(self):
        self.write("one/ground.obj", self.read("ground.obj"))
        os.remove(self.path("ground.obj"))
        self.write("puff.lua", PUFF)
        os.symlink("one/ground.obj", self.path("ground.obj"))
        self.fails(1, ["x.roil would not be whole", "ground.obj"], "bundle", "puff.lua", "-o", "x.roil")
        self.assertFalse(os.path.exists(self.path("x.roil")))
        self.fails(2, "a bundle's name ends with .roil", "bundle", "puff.lua", "-o", "x.tar")
        self.fails(2, "one effect is packed", "bundle")
        self.fails(1, "none.lua: No such file", "bundle", "none.lua")
        self.fails(1, "is a folder", "bundle", "one")

    def test_what_a_killed_process_left_is_removed(self):
        self.write("puff.lua", PUFF)
        self.succeeds("bundle", "puff.lua", "-o", "a.roil")
        busy = subprocess.Popen([PROGRAM, "render", "a.roil", "--frames", "1-10000", "-o", "o/%d.png", *SMALL], cwd=self.folder,
                                env={**os.environ, "ROIL_CACHE_DIR": self.cache}, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)
        while "of 10000 frames" not in busy.stderr.readline():  # it is at work
            self.assertIsNone(busy.poll())
        held = self.left()
        self.assertEqual(len(held), 1)
        self.succeeds("check", "a.roil")
        self.assertEqual(self.left(), held)  # it is still used
        busy.send_signal(signal.SIGKILL)
        busy.communicate()
        self.assertEqual(self.left(), held)
        self.succeeds("check", "a.roil")
        self.assertEqual(self.left(), [])


if __name__ == "__main__":
    main()
