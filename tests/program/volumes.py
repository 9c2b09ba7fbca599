"""Volumes of an effect as VDB files: they hold what the effect has, play back as it looked, and
Blender opens them."""
import array
import glob
import json
import os
import shutil
import subprocess

from lib.pictures import Png
from lib.program import SMALL, SOURCE, Case, main

FILES = os.path.join(SOURCE, "effects", "data", "explosion-32", "003*.vdb")
PLAYED = """
local fx = effect { name = "played", frames = 10 }
fx.camera = orbit { target = {4, 4, 2.5}, distance = 14 }
local burst = vdb { "%s/*.vdb" }
fx.output = final { march { density = burst.density * 8, emission = {0, 0, 0} + burst.heat * 0.1, steps = 48 } }.color
return fx
"""
BALL = """
local fx = effect { name = "ball", frames = 10 }
fx.camera = orbit { target = {0, 0, 1}, distance = 5 }
local high = curve { {0, 0.8}, {0.4, 1.2} }
local ball = sphere { position = {0, 0, 1}, radius = 0.8, falloff = 0.4 } * high
fx.output = final { march { density = %s, steps = 64 } }.color
return fx
"""
AIR = """
local fx = effect { name = "air", frames = 6 }
fx.camera = orbit { target = {0, 0, 1.2}, distance = 5 }
%s
fx.output = final { march { density = air.density * 30, emission = vec(0, air.temperature, 0) * 0.2, steps = 48 } }.color
return fx
"""
SIMULATED = """
local air = lbm { size = {16, 16, 24}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6, warm_up = 0.2, precision = "f32" }
air:source { shape = sphere { position = {0, 0, 0.5}, radius = 0.3 }, density = 1, temperature = 2 }
"""
# Frame f holds 100 f + x + 10 y + 0.25 z at voxel x, y, z.
SIZE, FRAMES = (12, 9, 5), 2
RAW = """
local fx = effect { name = "raw", fps = 10, frames = 2 }
fx.camera = orbit { target = {1, 1, 1}, distance = 6 }
local hot = raw { "data.raw", type = "f32", size = {12, 9, 5}, voxel_size = 0.5, fps = 10, channel = "heat", offset = {1, -2, 0.25} }
local wind = bake(vec(hot.heat, hot.heat * 2, 0), { size = {12, 9, 5}, box = hot.box })
fx.output = final { march { density = hot.heat + wind.x, steps = 4 } }.color
return fx
"""
# Frame f of the file holds 1 + f everywhere: what is exported says which frame is on show.
COUNTER = """
local fx = effect { name = "counter", fps = 10, frames = 40, first = 0 }
fx.camera = orbit { target = {1, 1, 1}, distance = 6 }
local rate = param { "rate", 100, min = 0, max = 150 }
local stop = param { "stop", false }
local late = param { "late", 0 }
%s
local count = raw { "count.raw", type = "f32", size = 2, fps = 10, blend = true, loop = "extend", %s }
fx.output = final { march { density = count.density, steps = 4 } }.color
return fx
"""
SLOWS = "function(t) return t < 1.5 and 1 or 0.5 end"
# Prints what Blender makes of the files that are named after it.
LOOK = """
import json, sys, bpy
for path in sys.argv[sys.argv.index("--") + 1:]:
    volume = bpy.data.volumes.new("volume")
    volume.filepath = path
    loaded = volume.grids.load()
    told = {"loaded": loaded, "error": volume.grids.error_message, "grids": {}}
    for grid in volume.grids:
        told["grids"][grid.name] = {"type": grid.data_type, "rows": [list(row) for row in grid.matrix_object]}
    try:
        import pyopenvdb
        grids, told["metadata"] = pyopenvdb.readAll(path)
        for grid in grids:
            known = told["grids"][grid.name]
            access = grid.getConstAccessor()
            known["values"] = [access.getValue((x, y, z)) for z in range(5) for y in range(9) for x in range(12)]
            known["class"] = grid.gridClass
    except ImportError:
        pass
    print("TOLD", json.dumps(told))
"""


def value(frame, index):
    x, y, z = index % 12, index // 12 % 9, index // 108
    return 100 * frame + x + 10 * y + 0.25 * z


class Volumes(Case):
    def picture(self, effect, *options):
        self.write("effect.lua", effect)
        self.succeeds("render", "effect.lua", "--frames", "5", "-o", "out.png", *SMALL, *options)
        return Png(self.read("out.png"))

    def apart(self, a, b):
        differences = [abs(p - q) for c in range(3) for p, q in zip(a.channel(c), b.channel(c))]
        return max(differences), sum(differences) / len(differences)

    def write_raw(self):
        voxels = SIZE[0] * SIZE[1] * SIZE[2]
        data = array.array("f", (value(f, i) for f in range(FRAMES) for i in range(voxels)))
        self.write("data.raw", data.tobytes())
        self.write("effect.lua", RAW)

    def test_a_sequence_comes_back_voxel_by_voxel(self):
        os.makedirs(self.path("data"))
        for file in glob.glob(FILES):
            shutil.copy(file, self.path("data"))
        wanted = self.picture(PLAYED % "data")
        told = self.succeeds("export", "vdb", "effect.lua", "--source", "burst", "-o", "again/%04d.vdb")
        self.assertIn("10 frames of density, temperature", told)
        self.assertEqual(len(os.listdir(self.path("again"))), 10)
        self.assertEqual(self.apart(wanted, self.picture(PLAYED % "again"))[0], 0)
        for grid in "density", "temperature":
            for name in "data", "again":
                self.succeeds("export", "raw", f"{name}/*.vdb", "-o", f"{name}.raw", "--type", "f16", "--grid", grid)
            self.assertEqual(self.read("data.raw"), self.read("again.raw"), grid)

    def test_what_is_simulated_plays_back_as_it_was(self):
        wanted = self.picture(AIR % SIMULATED)
        told = self.succeeds("export", "vdb", "effect.lua", "--fields", "density,temperature,velocity", "-o", "air/%d.vdb")
        self.assertIn("6 frames of density, temperature, velocity, 16 x 16 x 24 voxels of 0.1 m", told)
        info = self.succeeds("info", "air/5.vdb")
        self.assertRegex(info, r"velocity: vec3s \(saved as half\), fog volume, voxel 0.1 x 0.1 x 0.1 m")
        # The box is another, and so are the samples of the march.
        mean = self.apart(wanted, self.picture(AIR % 'local air = vdb { "air/*.vdb" }'))[1]
        late = self.apart(wanted, self.picture(AIR % 'local air = vdb { "air/*.vdb", start = 1 / 24 }'))[1]
        self.assertLess(mean, 0.1)
        self.assertGreater(late, 5 * mean)

    def test_the_medium_looks_the_same(self):
        wanted = self.picture(BALL % "ball * 3")
        told = self.succeeds("export", "vdb", "effect.lua", "-o", "ball/%d.vdb", "--size", "64")
        self.assertIn("10 frames of density", told)
        again = BALL.replace("local ball", 'local was = vdb { "ball/*.vdb" }\nlocal ball') % "was.density"
        self.assertLess(self.apart(wanted, self.picture(again))[1], 0.1)
        self.assertGreater(self.apart(wanted, self.picture(BALL % "ball * 2.5"))[1], 0.2) # it can tell

    def test_what_is_next_to_nothing_is_left_out(self):
        self.write("effect.lua", BALL % "ball * 3")
        sizes = []
        for tolerance in "0", "1":
            self.succeeds("export", "vdb", "effect.lua", "-o", "a.vdb", "--frames", "5", "--tolerance", tolerance)
            sizes.append(os.path.getsize(self.path("a.vdb")))
        self.assertLess(sizes[1], sizes[0])

    def test_blender_opens_them(self):
        if not shutil.which("blender"):
            self.skipTest("blender is not installed")
        self.write_raw()
        self.succeeds("export", "vdb", "effect.lua", "--source", "hot", "-o", "hot%d.vdb")
        self.succeeds("export", "vdb", "effect.lua", "--source", "wind", "--frames", "2", "-o", "wind.vdb")
        self.write("look.py", LOOK)
        done = subprocess.run(
            ["blender", "-b", "--factory-startup", "-noaudio", "--python", self.path("look.py"), "--",
             self.path("hot1.vdb"), self.path("hot2.vdb"), self.path("wind.vdb")],
            capture_output=True, text=True, timeout=120, check=False, env={**os.environ, "HOME": self.folder})
        told = [json.loads(line[5:]) for line in done.stdout.splitlines() if line.startswith("TOLD ")]
        self.assertEqual(len(told), 3, done.stdout + done.stderr)
        for number, (file, name) in enumerate(zip(told, ("temperature", "temperature", "wind"))):
            self.assertTrue(file["loaded"], file["error"])
            self.assertEqual(list(file["grids"]), [name])
            grid = file["grids"][name]
            self.assertEqual(grid["type"], "VECTOR_FLOAT" if name == "wind" else "FLOAT")
            # Voxel 0 lies half a voxel inside of the box.
            self.assertEqual(grid["rows"], [[0.5, 0, 0, 1.25], [0, 0.5, 0, -1.75], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])
            if "values" not in grid:
                continue # this Blender has no OpenVDB for Python
            wanted = [value(min(number, 1), i) for i in range(len(grid["values"]))]
            if name == "wind":
                wanted = [[v, 2 * v, 0] for v in wanted]
            for i, (got, right) in enumerate(zip(grid["values"], wanted)):
                for a, b in zip(got, right) if name == "wind" else [(got, right)]:
                    self.assertAlmostEqual(a, b, delta=abs(b) / 1024, msg=f"{name} {i}")
            self.assertEqual(grid["class"], "fog volume")
            self.assertEqual(file["metadata"]["frame"], min(number, 1) + 1)
            self.assertAlmostEqual(file["metadata"]["time"], min(number, 1) / 10)
            self.assertEqual(file["metadata"]["fps"], 10)
            self.assertEqual(file["metadata"]["effect"], "raw")
            self.assertRegex(file["metadata"]["creator"], r"roil \d")

    def test_info_says_how_a_file_is_read(self):
        self.write("effect.lua", BALL % "ball * 3")
        self.succeeds("export", "vdb", "effect.lua", "-o", "a.vdb", "--frames", "5", "--size", "8")
        data = self.read("a.vdb")
        begin = data.index(b"roil ")
        length = int.from_bytes(data[begin - 4:begin], "little")
        for creator, turned in ("Houdini", True), ("Blender", False):
            self.write("by.vdb", data[:begin] + creator.encode().ljust(length) + data[begin + length:])
            info = self.succeeds("info", "by.vdb")
            self.assertIn("creator = " + creator, info)
            self.assertEqual("Y up, as its creator makes them" in info, turned)
            self.assertNotIn("resampled", info)
        corpus = os.path.join(SOURCE, "tests", "fuzz", "corpus", "fuzz_vdb")
        for name, told in ("turned", ", rotated: it is resampled"), ("frustum", "frustum transform, which roil cannot read"):
            self.assertIn(told, self.succeeds("info", os.path.join(corpus, name + ".vdb")))

    def shown(self, script, frames, *options):
        """What frames of the effect show of `count.raw`, in frames since its first."""
        self.write("count.raw", array.array("f", (1 + i // 8 for i in range(8 * 80))).tobytes())
        self.write("effect.lua", COUNTER % script)
        shutil.rmtree(self.path("count"), ignore_errors=True)
        self.succeeds("export", "vdb", "effect.lua", "--source", "count", "--frames", frames, "-o", "count/%d.vdb", *options)
        self.succeeds("export", "raw", "count/*.vdb", "-o", "shown.raw", "--type", "f32")
        values = array.array("f", self.read("shown.raw"))
        size = len(values) // len(os.listdir(self.path("count")))
        return [max(values[i:i + size]) - 1 for i in range(0, len(values), size)]

    def plays(self, script, wanted, *options):
        frames = range(len(wanted))
        got = self.shown(script, f"0-{len(wanted) - 1}", *options)
        for frame in frames:
            self.assertAlmostEqual(got[frame], wanted[frame], delta=0.02, msg=f"{script}, frame {frame}: {got}")
        for frame in (frames[-1], frames[len(frames) // 2]): # jumped to
            alone = self.shown(script, str(frame), *options)[0]
            self.assertAlmostEqual(alone, wanted[frame], delta=0.02, msg=f"{script}, frame {frame} alone")

    def test_speed_and_start_move(self):
        slows = [min(k, 15) + max(k - 15, 0) / 2 for k in range(24)]
        self.plays(("", "speed = " + SLOWS), slows)
        # From the middle of each frame to the next, also where `update` says it.
        moved = [0.0]
        for k in range(1, 16):
            moved.append(moved[-1] + (1.5 if k < 6 else 0 if k < 11 else 0.5))
        update = "fx.update = function(t) rate:set(t < 0.55 and 150 or t < 1.05 and 0 or 50) end"
        self.plays((update, "speed = rate / 100"), moved)
        back = self.shown((update, "speed = rate / 100"), "12,4") # back in time
        for got, frame in zip(back, (4, 12)):
            self.assertAlmostEqual(got, moved[frame], delta=0.02)
        self.plays(("", "speed = rate / 100"), [k * 1.25 for k in range(8)], "--set", "rate=125")
        self.plays(("", "speed = 1 - stop"), [0] * 5, "--set", "stop=true")
        self.plays(("", "speed = 1 - stop"), list(range(5)))
        # The first frame is shown at the start, whatever the speed was before it.
        self.plays(("", "start = late, speed = 2"), [max(0, 2 * (k - 3)) for k in range(8)], "--set", "late=0.3")
        self.plays(("", "start = 1, speed = " + SLOWS), [max(0, slows[k] - slows[10]) for k in range(24)])
        self.plays(("", "start = -0.5, speed = " + SLOWS), [5 + k for k in range(8)])
        self.plays(("", "start = function(t) return t / 2 end"), [k / 2 for k in range(8)])

    def test_mistakes(self):
        self.write_raw()
        export = ["export", "vdb", "effect.lua"]
        self.fails(2, "which effect?", "export", "vdb")
        self.fails(2, "-o is missing", *export)
        self.fails(2, "accepted: .vdb", *export, "-o", "a.raw")
        self.fails(2, "would be overwritten", *export, "-o", "a.vdb")
        self.fails(2, "1 to 1024 voxels", *export, "-o", "a.vdb", "--size", "0")
        self.fails(2, "the least and the greatest corner", *export, "-o", "a.vdb", "--box", "1,1,1,0,2,2")
        one = [*export, "--frames", "1", "-o", "a.vdb"]
        self.fails(1, "no grid or medium 'cold'; there are: hot, wind, march", *one, "--source", "cold")
        self.fails(1, "no grid named 'fuel' can be read", *one, "--source", "hot", "--fields", "heat,fuel")
        self.fails(1, "is named twice", *one, "--source", "hot", "--fields", "heat,heat")
        self.fails(1, "'emission' is not given", *one, "--source", "march", "--fields", "emission")
        self.fails(1, "cannot be written", *export, "--frames", "1", "-o", "/proc/a.vdb", "--source", "hot")
        self.assertFalse(os.path.exists(self.path("a.vdb")))


if __name__ == "__main__":
    main()
