"""What was looked at is what is opened: a link that takes the place of a file, or of a folder on its way, between
the look and the opening (../fault/swap.c) leads nowhere that files of strangers may not lead. So each caller that
opens such a file says below which folder, and does not rely on the look alone."""
import ctypes
import os
import shutil
import struct
import tempfile

from lib.program import BINARY, GROUND, PUFF, SMALL, Case, main
from places import EXR, READERS, with_text

LIBRARY = os.path.join(BINARY, "libswap.so")
IN_OPEN, MOST = 0x20, 24  # looks at one file, of one process
KINDS = {**READERS, "picture, EXR": ("x.exr", EXR, READERS["picture"][2])}
DRAWN = "raw", "vdb frames"  # whose frames are read when they are shown
RENDER = ["render", "in/puff.lua", "--frames", "1", "-o", "out.png", *SMALL]
LIBC = ctypes.CDLL(None, use_errno=True)


class Watch:
    """Whether a file has been opened."""

    def __init__(self, path):
        self.fd = LIBC.inotify_init1(os.O_NONBLOCK)
        if self.fd < 0 or LIBC.inotify_add_watch(self.fd, path.encode(), IN_OPEN) < 0:
            raise OSError(ctypes.get_errno(), path)

    def opened(self):
        try:
            return len(os.read(self.fd, 4096)) >= struct.calcsize("iIII")
        except BlockingIOError:
            return False

    def close(self):
        os.close(self.fd)


class Swapped(Case):
    def run_and_swap(self, at, seen, thing, target, *args):
        return self.run_program(*args, environment={
            "LD_PRELOAD": LIBRARY, "ROIL_SWAP_AT": str(at), "ROIL_SWAP_TARGET": target,
            "ROIL_SWAP_SEEN": os.path.realpath(seen), "ROIL_SWAP_THING": os.path.realpath(thing)})

    def swap_everywhere(self, name, content, arrange, *args):
        """Runs a command once for each time that it looks at the file in/sub/NAME, which is another one then.
        `arrange()` writes all that the command reads but that file. How many looks there were."""
        outside = tempfile.mkdtemp(prefix="roil-outside-")  # not below the folder that the program runs in
        self.addCleanup(shutil.rmtree, outside)
        shutil.copy(self.write("in/sub/" + name, content), outside)
        file, target = self.path("in/sub/" + name), os.path.join(os.path.realpath(outside), name)
        looks = 0
        for thing, to in (file, target), (os.path.dirname(file), os.path.dirname(target)):
            for at in range(1, MOST):
                shutil.rmtree(self.path("in"), ignore_errors=True)
                self.write("in/sub/" + name, content)
                arrange()
                watch = Watch(target)
                done = self.run_and_swap(at, file, thing, to, *args)
                opened = watch.opened()
                watch.close()
                self.assertIn(done.returncode, (0, 1), done.stderr)
                self.assertFalse(opened, f"{name}: swapped after look {at}: {done.stdout}{done.stderr}")
                if not os.path.islink(thing):
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    looks += at - 1
                    break
            else:
                self.fail(f"{name}: more than {MOST} looks")
        return looks

    def test_what_an_effect_names(self):
        for reader, (name, content, files) in KINDS.items():
            with self.subTest(reader):
                command = RENDER if reader in DRAWN else ["check", "in/puff.lua"]
                file = name.replace("*", "1")
                named = "sub/" + (name[:-len(".lua")] if name.endswith(".lua") else name)

                def arrange(files=files, named=named):
                    self.write("in/ground.obj", GROUND)
                    for at, text in files.items():
                        self.write("in/" + at, text.replace("%s", named))

                self.assertGreater(self.swap_everywhere(file, content, arrange, *command), 0)

    def test_the_effect_of_a_recipe(self):
        self.write("in/sub/x.lua", PUFF)
        self.write("in/sub/ground.obj", GROUND)
        self.succeeds("render", "in/sub/x.lua", "--frames", "1", "-o", "shot.png", *SMALL)
        shot = with_text(self.read("shot.png"), b"roil:effect", b"in/sub/x.lua")

        def arrange():
            self.write("in/sub/ground.obj", GROUND)
            self.write("shot.png", shot)

        self.assertGreater(self.swap_everywhere("x.lua", PUFF, arrange, "render", "--from", "shot.png",
                                                "-o", "out.png"), 0)

    def test_the_effect_of_a_sweep(self):
        for measure in "", ', measure = "reload", axes = { axis { "edit", { name = "a", edit = {"-- a", "-- b"} } } }':
            with self.subTest(measure):
                def arrange(measure=measure):
                    self.write("in/sub/ground.obj", GROUND)
                    self.write("in/sweep.lua", 'return sweep { name = "try", effect = "sub/x.lua", size = {32, 18}, '
                               'frames = "3", repeats = 1, warmup = 0%s }' % measure)

                self.assertGreater(self.swap_everywhere("x.lua", PUFF + "-- a\n", arrange, "bench", "in/sweep.lua",
                                                        "-o", "out"), 0)

    def test_presets(self):
        def arrange():
            self.write("in/puff.lua", PUFF)
            self.write("in/ground.obj", GROUND)
            os.symlink("sub", self.path("in/puff.presets"))

        self.assertGreater(self.swap_everywhere("warm.lua", "return {}\n", arrange, "info", "params", "in/puff.lua",
                                                "--preset", "warm"), 0)

    def test_pictures_of_results(self):
        self.write("puff.lua", PUFF)
        self.write("sweep.lua", 'return sweep { name = "try", effect = "puff.lua", size = {32, 18}, frames = "3",\n'
                   'settle = 0, axes = { axis { "steps", 8 } } }')
        self.succeeds("bench", "sweep.lua", "-o", "good", "--no-reference")
        picture = self.read("good/rows/0000.png")

        def arrange():
            shutil.copy(self.path("good/results.json"), self.path("in/results.json"))
            shutil.rmtree(self.path("merged"), ignore_errors=True)
            os.symlink("sub", self.path("in/rows"))

        for command in ["bench", "--report", "in"], ["bench", "--merge", "in", "-o", "merged"]:
            with self.subTest(command[1]):
                self.swap_everywhere("0000.png", picture, arrange, *command)

    def test_results_are_written_below_their_folder(self):
        self.write("puff.lua", PUFF)
        self.write("sweep.lua", 'return sweep { name = "try", effect = "puff.lua", size = {32, 18}, frames = "3",\n'
                   'settle = 0, axes = { axis { "steps", 8 } } }')
        rows, outside = self.path("out/rows"), tempfile.mkdtemp(prefix="roil-outside-")
        self.addCleanup(shutil.rmtree, outside)
        for at in range(1, MOST):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            os.makedirs(rows)
            done = self.run_and_swap(at, rows, rows, outside, "bench", "sweep.lua", "-o", "out", "--no-reference")
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertEqual(os.listdir(outside), [], f"swapped after look {at}")
            if not os.path.islink(rows):
                self.assertGreater(at, 1)
                return
        self.fail("more looks than expected")


if __name__ == "__main__":
    main()
