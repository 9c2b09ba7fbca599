"""An engine with a Vulkan device of its own (tests/embed/engine.c) has two effects in its picture: they are there what
`roil render` makes of them, and the engine's walls stand before and behind them."""
import math
import os
import random
import struct

from lib.pictures import Exr
from lib.program import BINARY, Case, SOURCE, main

ENGINE, EFFECTS = os.path.join(BINARY, "engine"), os.path.join(SOURCE, "tests", "embed")
WIDTH, HEIGHT, LAST = 96, 54, 59
SAMPLE = 8  # calls that fail
FAR, NEAR = os.path.join(EFFECTS, "far.lua"), os.path.join(EFFECTS, "near.lua")
WALL = (0.30, 0.26, 0.22)
TRIANGLES = [(((-3, 0, -0.5), (0.3, 0, -0.5), (-3, 0, 1.6)), WALL),  # of engine.glsl
             (((-3, 0, 1.6), (0.3, 0, -0.5), (0.3, 0, 1.6)), WALL),
             (((0.6, -1, -0.4), (1.9, -0.2, -0.4), (1.2, 1.2, 1.4)), (0.05, 0.12, 0.30))]


def layer_at(layer, x, y):
    return layer[0][y][x], layer[1][y][x]


def over(layer, behind):
    return tuple(c + t * b for c, t, b in zip(*layer, behind))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(u * v for u, v in zip(a, b))


def ray_at(x, y):
    """Of place_camera in engine.c: where it begins, and its way."""
    yaw, pitch, half = math.radians(-90 + 0.25 * LAST), math.radians(10), math.tan(math.radians(22.5))
    back = (math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), math.sin(pitch))
    right = (-math.sin(yaw), math.cos(yaw), 0)
    up = cross(back, right)
    across, above = (2 * x / WIDTH - 1) * half * WIDTH / HEIGHT, (1 - 2 * y / HEIGHT) * half
    return tuple(7 * b for b in back), tuple(across * r + above * u - b for r, u, b in zip(right, up, back))


def hit(origin, way, corners):
    """How far away, or None (Moeller and Trumbore 1997)."""
    a, b, c = corners
    first, second = tuple(u - v for u, v in zip(b, a)), tuple(u - v for u, v in zip(c, a))
    p = cross(way, second)
    part = 1 / dot(first, p)
    s = tuple(u - v for u, v in zip(origin, a))
    q = cross(s, first)
    u, v = part * dot(s, p), part * dot(way, q)
    return part * dot(second, q) if min(u, v, 1 - u - v) >= 0 else None


def nearest(x, y):
    found = [(away, color) for corners, color in TRIANGLES if (away := hit(*ray_at(x, y), corners)) is not None]
    return min(found)[1] if found else None


def surface_at(x, y):
    """Colour of the triangle in a pixel; None: there is none; "edge": in a part of it."""
    found = {nearest(x + i, y + j) for i in (0.1, 0.5, 0.9) for j in (0.1, 0.5, 0.9)}
    return found.pop() if len(found) == 1 else "edge"


def choose(count):
    """A call of each of some equal parts, or each step-th: ROIL_ENGINE_FAULTS says the step."""
    step = int(os.environ.get("ROIL_ENGINE_FAULTS", "0"))
    chance = random.Random(count)
    return range(1, count + 1, step) if step else [int((i + chance.random()) * count / SAMPLE) + 1 for i in range(SAMPLE)]


class Host(Case):
    def engine(self, *arguments, far=FAR, near=NEAR, **environment):
        return self.run_program(far, near, "engine.pfm", *arguments, program=ENGINE, environment=environment)

    def picture(self):
        """By row from the top, then by column: red, green, blue."""
        data = self.read("engine.pfm")
        head = f"PF\n{WIDTH} {HEIGHT}\n-1.0\n".encode()
        self.assertTrue(data.startswith(head))
        values = list(struct.iter_unpack("<fff", data[len(head):]))
        return [values[y * WIDTH:(y + 1) * WIDTH] for y in reversed(range(HEIGHT))]

    def alike(self, a, b, where):
        """As far as halves go, twice over."""
        for u, v in zip(a, b):
            self.assertLess(abs(u - v), 2e-3 + 2e-3 * abs(v), where)

    def layer(self, effect):
        """What the program makes of it: colour and transmittance by pixel."""
        done = self.run_program("render", effect, "-o", "shown.png", "--frames", str(LAST), "--size", f"{WIDTH}x{HEIGHT}",
                                "--dump-pass", "march.color", "color.exr", "--dump-pass", "march.transmittance", "through.exr")
        self.assertEqual(done.returncode, 0, done.stderr)
        files = [Exr(self.read(name)) for name in ("color.exr", "through.exr")]
        return [[[(f.channels["R"][y * WIDTH + x], f.channels["G"][y * WIDTH + x], f.channels["B"][y * WIDTH + x])
                  for x in range(WIDTH)] for y in range(HEIGHT)] for f in files]

    def test_layers_are_in_the_engines_picture(self):
        done = self.engine()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        picture, far, near = self.picture(), self.layer(FAR), self.layer(NEAR)
        counts = {"free": 0, "bare": 0, "hidden": 0, "cut": 0}
        for y in range(HEIGHT):
            for x in range(WIDTH):
                seen, behind, before = picture[y][x], layer_at(far, x, y), layer_at(near, x, y)
                solid = surface_at(x, y)
                if solid == "edge":
                    continue
                clear = min(before[1]) == 1
                if solid is None:
                    self.alike(seen, over(before, over(behind, (0, 0, 0))), (x, y))
                    counts["free"] += min(before[1] + behind[1]) < 0.9
                elif clear and (solid == WALL or min(behind[1]) == 1):  # the far layer is behind the wall
                    self.alike(seen, solid, (x, y))
                    counts["bare" if min(behind[1]) == 1 else "hidden"] += 1
                elif solid == WALL:  # which the near layer goes through
                    whole = over(before, solid)
                    counts["cut"] += max(map(abs, (a - b for a, b in zip(seen, whole)))) > 0.05
                    self.assertLess(max(a - b for a, b in zip(seen, whole)), 0.05 + max(solid))
        for what, count in counts.items():
            self.assertGreater(count, 20, what)

    def test_a_device_budget_too_small_is_said(self):
        done = self.engine("1", ENGINE_MEMORY="1M", ENGINE_BARE="1")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, "^engine: .*`device_memory` of roil_desc sets another limit.*\n$")
        self.assertFalse(os.path.exists(self.path("engine.pfm")))

    def test_calls_that_fail_are_said(self):
        """A sample of the calls of Vulkan, the engine's and roil's, fails, each once: with a message, and nothing is
        left behind that validation or the engine's allocator knows of. A frame that failed can be drawn again."""
        counts = self.path("counts")
        faults = {"LD_PRELOAD": os.path.join(BINARY, "libfault.so"), "ROIL_FAULT_FILE": counts}
        done = self.engine("2", **faults)
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = self.read("engine.pfm")
        calls = struct.unpack("<Q", self.read("counts")[:8])[0]
        self.assertGreater(calls, 100)
        for number in choose(calls):
            with self.subTest(call=number):
                self.write("counts", b"")
                done = self.engine("2", ROIL_FAULT=f"vulkan {number} once", **faults)
                self.assertIn(done.returncode, (0, 1), done.stderr)
                self.assertNotIn("validation: ", done.stderr)
                lines = [line for line in done.stderr.splitlines() if line.startswith("engine: ")]
                self.assertLessEqual(done.returncode, len(lines), done.stderr)
                self.assertLessEqual(len(lines), 1, done.stderr)
                self.assertTrue(done.returncode == 1 or self.read("engine.pfm") == expected, done.stderr)


if __name__ == "__main__":
    main()
