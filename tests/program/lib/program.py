"""Runs the program as a user does, in a scratch folder, and holds it to its promises: the exit
status, one message that begins with "roil: " and says what was wrong, and no crash."""
import os
import shutil
import subprocess
import tempfile
import unittest

SOURCE = os.environ.get("ROIL_SOURCE_DIR") or os.path.abspath(
    os.path.join(os.path.dirname(__file__), "../../.."))
BINARY = os.environ.get("ROIL_BINARY_DIR") or os.path.join(SOURCE, "build")
PROGRAM = os.path.join(BINARY, "roil")
DATA = os.path.join(SOURCE, "tests/program/data")
CORPUS = os.path.join(SOURCE, "tests/fuzz/corpus")
SMALL = ["--size", "96x54"]
SECONDS = 120  # a run that takes longer hangs

# A ball of smoke over open ground: quick to draw, with all that an effect has.
PUFF = """
local fx = effect { name = "puff", fps = 24, frames = 10 }
local thickness = param { "thickness", 4, min = 0, max = 100, unit = "1/m", help = "of the smoke" }
local steps = param { "steps", 8, min = 2, max = 64, integer = true, help = "along each ray" }
local look = param { "look", "soft", words = { "soft", "hard" }, help = "nothing" }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 10 }
local ground = geometry { mesh { "ground.obj" } }
local solid = shade { from = ground }
local ball = sphere { position = {0, 0, 1}, radius = 1, falloff = 0.5 }
local volume = march { density = ball * perlin { frequency = 2 } * thickness, emission = {0.4, 0.1, 0},
                       depth = ground.depth, steps = steps, shadow_steps = 2 }
local shown = final { over { volume = volume.color, edge = volume.edge, source = solid, depth = ground.depth } }
fx.output = shown.color
fx.linear = shown.linear
fx.depth = ground.depth
return fx
"""

GROUND = "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nf 1 2 3 4\n"

# Nothing but a march: `%s` is its density. Its background is transparent.
VOLUME = """
local fx = effect { name = "volume" }
fx.camera = orbit { target = {1, 1, 1}, distance = 6 }
local volume = march { density = %s, steps = 8, shadow_steps = 2 }
fx.output = final { volume.color }.color
return fx
"""


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="roil-program-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("ground.obj", GROUND)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())
        return path

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def run_program(self, *args, environment=None, program=PROGRAM, before=None):
        done = subprocess.run(
            [program, *args], cwd=self.folder, env={**os.environ, **(environment or {})},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            errors="replace", timeout=SECONDS, check=False, preexec_fn=before)
        self.assertGreaterEqual(done.returncode, 0, f"roil {args} was killed:\n{done.stderr}")
        self.assertNotIn("VUID", done.stderr)
        return done

    def succeeds(self, *args, **options):
        """The program's output."""
        done = self.run_program(*args, **options)
        self.assertEqual(done.returncode, 0, f"roil {args}:\n{done.stderr}")
        return done.stdout

    def fails(self, status, says, *args, **options):
        """The message, which must hold every text in `says`."""
        done = self.run_program(*args, **options)
        self.assertEqual(done.returncode, status, f"roil {args}:\n{done.stdout}{done.stderr}")
        messages = [line for line in done.stderr.splitlines() if line.startswith("roil: ")]
        self.assertEqual(len(messages), 1, f"not one message:\n{done.stderr}")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        return done.stderr

    def refuses(self, effect, says):
        """The effect file is bad, and `roil check` says why."""
        self.write("effect.lua", effect)
        return self.fails(1, says, "check", "effect.lua")

    def cannot_draw(self, effect, says):
        """Rendering says why, and leaves nothing behind."""
        self.write("effect.lua", effect)
        message = self.fails(1, says, "render", "effect.lua", "--frames", "1", "-o", "out.png", *SMALL)
        self.assertFalse(os.path.exists(self.path("out.png")))
        return message

    def render(self, effect, *args, output="out.png", **options):
        """One small frame, unless `args` say otherwise."""
        self.write("effect.lua", effect)
        if "--frames" not in args:
            args = ["--frames", "1", *args]
        return self.succeeds("render", "effect.lua", "-o", output, *SMALL, *args, **options)


main = unittest.main
