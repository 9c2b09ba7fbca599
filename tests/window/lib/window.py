"""A real window on a display that nobody sees: Xvfb shows it, xdotool works its keys and pointer,
and what it shows is read back. Nothing waits for a time: every step waits for what it should cause,
and fails when that has not come after PATIENCE seconds."""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zlib

SOURCE = os.environ.get("ROIL_SOURCE_DIR") or os.path.abspath(
    os.path.join(os.path.dirname(__file__), "../../.."))
BINARY = os.environ.get("ROIL_BINARY_DIR") or os.path.join(SOURCE, "build")
PROGRAM = os.path.join(BINARY, "roil")
PATIENCE = 60
SCREEN = (1600, 1000)
TOOLS = ["Xvfb", "xdotool", "xwd", "xprop", "xclip"]

# A ball of smoke that is quick to draw, and has a control of each kind.
PUFF = """
local fx = effect { name = "puff", fps = 24, frames = 48 }
local thickness = param { "thickness", 4, min = 0, max = 20, unit = "1/m", help = "of the smoke" }
local size = param { "size", 1, min = 0.1, max = 10, log = true, unit = "m", help = "of the ball", group = "shape" }
local steps = param { "steps", 8, min = 2, max = 64, integer = true, help = "along each ray" }
local look = param { "look", "soft", words = { "soft", "hard" }, help = "of the edge", group = "shape" }
local tint = param { "tint", "#ff8040", help = "of the light" }
local glow = param { "glow", true, help = "whether it shines" }
local place = param { "place", {0, 0, 1}, min = -4, max = 4, unit = "m", help = "of the ball" }
local fire = palette { {0, "#000000"}, {0.4, "#7a1500"}, {1, "#fff3b0"} }
local swell = curve { {0, 0.6}, {1, 1}, {2, 0.8}, shape = "cubic" }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 10 }
local edge = look:get() == "soft" and 0.6 or 0.05
local ball = sphere { position = place, radius = size * swell, falloff = edge }
local volume = march { density = ball * thickness, emission = fire(ball).rgb * tint * 2, steps = steps, shadow_steps = 1 }
fx.output = final { volume.color }.color
return fx
"""

# A slice that is quick to simulate, in which something rises.
RISE = """
local fx = effect { name = "rise", fps = 24, frames = 240 }
local air = slices { count = 1, size = {32, 32}, height = 2, variation = 0 }
air:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density = 1, velocity = {0, 1} }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 10 }
fx.output = final { march { density = air.density * 4, steps = 4, shadow_steps = 1 } }.color
return fx
"""


def require_tools():
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        print(f"skipped: {', '.join(missing)} not installed")
        sys.exit(77)


class Picture:
    """8-bit RGB, as `xwd` gives it or a PNG holds it."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    @staticmethod
    def of_xwd(data):
        head = struct.unpack(">25I", data[:100])
        size, width, height, order, bits, stride, colors = (
            head[0], head[4], head[5], head[7], head[11], head[12], head[19])
        assert bits == 32 and order == 0, "little-endian 32 bits a pixel are expected"
        pixels = data[size + colors * 12:]
        rows = []
        for y in range(height):
            row = pixels[y * stride:y * stride + width * 4]
            rgb = bytearray(width * 3)
            rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
            rows.append(bytes(rgb))
        return Picture(width, height, rows)

    def pixel(self, x, y):
        return tuple(self.rows[int(y)][int(x) * 3:int(x) * 3 + 3])

    def crop(self, left, top, right, bottom):
        left, top, right, bottom = (int(round(v)) for v in (left, top, right, bottom))
        rows = [row[left * 3:right * 3] for row in self.rows[top:bottom]]
        return Picture(right - left, bottom - top, rows)

    def colors(self):
        return len({row[i:i + 3] for row in self.rows for i in range(0, len(row), 3)})

    def mean(self):
        count = self.width * self.height
        return tuple(sum(sum(row[c::3]) for row in self.rows) / count for c in range(3))

    def save(self, path):
        def chunk(kind, data):
            body = kind + data
            return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
        raw = b"".join(b"\0" + row for row in self.rows)
        with open(path, "wb") as f:
            f.write(b"\x89PNG\r\n\x1a\n")
            f.write(chunk(b"IHDR", struct.pack(">2I5B", self.width, self.height, 8, 2, 0, 0, 0)))
            f.write(chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b""))


def difference(a, b):
    """Greatest difference of a channel."""
    if (a.width, a.height) != (b.width, b.height):
        return 256
    return max((abs(x - y) for p, q in zip(a.rows, b.rows) if p != q for x, y in zip(p, q)),
               default=0)


class Display:
    """An X server of our own, for all tests of a class; `density` in dots an inch."""

    def __init__(self, density=96):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-noreset", "-displayfd", str(write), "-screen", "0", "%dx%dx24" % SCREEN, "-nolisten",
             "tcp"], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.name = ":" + number.readline().strip()
        if density != 96:
            subprocess.run(["xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set",
                            "RESOURCE_MANAGER", f"Xft.dpi: {density}"], check=True,
                           env={**os.environ, "DISPLAY": self.name}, timeout=PATIENCE)

    def close(self):
        self.server.terminate()
        self.server.wait()


class Live:
    """A running `roil live`. `log` holds its stderr, line by line, as it comes."""

    def __init__(self, case, *args, environment=None):
        self.case = case
        self.log, self.read_to = [], 0
        self.news = threading.Condition()
        self.ended = False
        self.process = subprocess.Popen(
            [PROGRAM, "live", *args], cwd=case.folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
            env={**case.environment, **(environment or {})})
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            with self.news:
                self.log.append(line.rstrip("\n"))
                self.news.notify_all()
        with self.news:
            self.ended = True
            self.news.notify_all()

    def text(self):
        return "\n".join(self.log[-60:])

    def expect(self, pattern, mark=None):
        """The match of a line of the log that comes after `mark` (default: after the last match)."""
        expression = re.compile(pattern)
        at = self.read_to if mark is None else mark
        end = time.monotonic() + PATIENCE
        with self.news:
            while True:
                while at < len(self.log):
                    match = expression.search(self.log[at])
                    at += 1
                    if match:
                        self.read_to = at
                        return match
                if self.ended or not self.news.wait(max(0, end - time.monotonic())):
                    if self.ended or time.monotonic() >= end:
                        self.case.fail(f"no line like '{pattern}':\n{self.text()}")

    def mark(self):
        return len(self.log)

    def quit(self):
        """Ends it by its own key; it must leave with status 0 and without a complaint."""
        self.keys("ctrl+q")
        self.process.wait(PATIENCE)
        self.reader.join(PATIENCE)
        self.case.assertEqual(self.process.returncode, 0, self.text())
        self.case.assertNotIn("VUID", "\n".join(self.log))
        self.case.assertNotIn("SYNC-HAZARD", "\n".join(self.log))

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.reader.join(PATIENCE)
        self.process.stdout.close()

    # ---- hands --------------------------------------------------------------------------------

    def tool(self, *args):
        return subprocess.run(["xdotool", *map(str, args)], env=self.case.environment, check=True,
                              stdout=subprocess.PIPE, text=True, timeout=PATIENCE).stdout

    def window(self):
        return self.tool("search", "--sync", "--onlyvisible", "--name", "roil").split()[0]

    def keys(self, *keys):
        self.tool("key", *keys)

    def type(self, text):
        self.tool("type", "--delay", "15", text)

    def click(self, x, y, button=1):
        self.tool("mousemove", round(x), round(y), "click", button)

    def drag(self, start, end, button=1, steps=6):
        """Presses, moves in steps, as a hand does, and releases."""
        x, y = start
        commands = ["mousemove", round(x), round(y), "mousedown", button]
        for i in range(1, steps + 1):
            commands += ["mousemove", round(x + (end[0] - x) * i / steps),
                         round(y + (end[1] - y) * i / steps), "sleep", "0.03"]
        self.tool(*commands, "mouseup", button)

    # ---- eyes ---------------------------------------------------------------------------------

    def screenshot(self):
        data = subprocess.run(["xwd", "-silent", "-id", self.window()], env=self.case.environment,
                              check=True, stdout=subprocess.PIPE, timeout=PATIENCE).stdout
        return Picture.of_xwd(data)

    def wait_until(self, condition, what):
        """Asks again until it holds; returns what it returned."""
        end = time.monotonic() + PATIENCE
        while True:
            value = condition()
            if value:
                return value
            if time.monotonic() > end or self.ended:
                self.case.fail(f"{what} did not come:\n{self.text()}")
            with self.news:  # whatever happens is likely to be logged
                self.news.wait(0.1)

    def widgets(self):
        """Rectangles of what can be used, by name, as the window wrote them last."""
        try:
            with open(self.case.widgets, encoding="utf-8") as f:
                return json.load(f)
        except (FileNotFoundError, json.JSONDecodeError):
            return {}

    def widget(self, name):
        """Left, top, right, bottom of a widget, once it is there and stays where it is."""
        last = [None]

        def steady():
            now = self.widgets().get(name)
            same, last[0] = now is not None and now == last[0], now
            return now if same else None
        return self.wait_until(steady, f"widget '{name}'")

    def middle(self, name):
        left, top, right, bottom = self.widget(name)
        return (left + right) / 2, (top + bottom) / 2

    def click_on(self, name, button=1):
        self.click(*self.middle(name), button)


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display()
        cls.addClassCleanup(cls.display.close)

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="roil-window-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.widgets = os.path.join(self.folder, "widgets.json")
        self.environment = {**os.environ, "DISPLAY": self.display.name, "ROIL_LOG": "debug",
                            "ROIL_STATE_DIR": os.path.join(self.folder, "state"),
                            "ROIL_WIDGETS": self.widgets, "ROIL_VALIDATE": "1"}
        self.environment.pop("WAYLAND_DISPLAY", None)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """As editors do that are careful: to another file, then renamed over the first."""
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path + "~", "w", encoding="utf-8") as f:
            f.write(text)
        os.replace(path + "~", path)
        return path

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as f:
            return f.read()

    def live(self, *args, effect=PUFF, **options):
        """The window, once it has drawn its first frame."""
        if effect is not None:
            self.write("puff.lua", effect)
        live = Live(self, "puff.lua", "--size", "1200x720", "--paused", *args, **options)
        self.addCleanup(live.kill)
        live.expect("live: first frame")
        live.tool("windowfocus", "--sync", live.window())
        return live


main = unittest.main
