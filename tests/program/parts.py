"""Work in parts, as machines of a farm share it: shards, what is there already, states on the way."""
import os
import signal
import subprocess
import time

from lib.program import PROGRAM, PUFF, SMALL, Case, main

AIR = """
local fx = effect { name = "air", fps = 30, frames = 12 }
fx.camera = orbit { target = {0, 0, 0.8}, distance = 4 }
local heat = param { "heat", 2 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1, temperature = heat }
local sparks = particles { count = 64, rate = 100, velocity = air.velocity, position = {0, 0, 0.5} }
local picture = march { density = air.density * 30, steps = 8 }
fx.output = final { over { splats { from = sparks, size = 0.05 }, picture } }.color
return fx
"""


class Parts(Case):
    def setUp(self):
        super().setUp()
        self.write("puff.lua", PUFF)
        self.write("air.lua", AIR)

    def files(self, folder):
        return {name: self.read(f"{folder}/{name}") for name in sorted(os.listdir(self.path(folder)))}

    def draw(self, effect, folder, *arguments):
        return self.succeeds("render", effect, "-o", folder + "/%02d.png", *SMALL, *arguments)

    def test_shards_are_the_whole(self):
        self.draw("puff.lua", "whole")
        for shard in range(1, 4):
            self.draw("puff.lua", "parts", "--shard", f"{shard}/3")
            self.assertEqual(len(self.files("parts")), 10 * shard // 3)
        self.assertEqual(self.files("parts"), self.files("whole"))
        self.draw("puff.lua", "some", "--frames", "1-9:2", "--shard", "2/2")
        self.assertEqual(list(self.files("some")), ["05.png", "07.png", "09.png"])
        self.succeeds("render", "puff.lua", "--shard", "1/20", "-o", "none/%d.png", *SMALL)
        self.assertFalse(os.path.exists(self.path("none")))

    def test_what_is_there_and_whole_is_left(self):
        draw = ["render", "puff.lua", "--frames", "1-4", "-o", "a/%02d.png", "-o", "a/%02d.exr", "--skip-existing", *SMALL]
        self.succeeds(*draw)
        whole = self.files("a")
        self.write("a/02.png", whole["02.png"][:-20])
        self.write("a/03.exr", whole["03.exr"][:len(whole["03.exr"]) // 2])
        os.remove(self.path("a/04.exr"))
        before = {name: os.stat(self.path("a/" + name)).st_mtime_ns for name in ("01.png", "01.exr")}
        self.assertIn("1 frames were there", self.succeeds(*draw))
        self.assertEqual(self.files("a"), whole)
        for name, changed in before.items():
            self.assertEqual(os.stat(self.path("a/" + name)).st_mtime_ns, changed)
        said = self.succeeds(*draw)
        self.assertIn("4 frames were there", said)
        self.assertNotIn("wrote", said)

    def test_states_on_the_way(self):
        self.draw("air.lua", "whole", "--checkpoint", "drawn/%02d.state", "--checkpoint-every", "4")
        self.succeeds("render", "air.lua", *SMALL, "--simulate-only", "--checkpoint", "sim/%02d.state", "--checkpoint-every", "4")
        self.assertEqual(list(self.files("sim")), ["04.state", "08.state", "12.state"])
        self.assertEqual(self.files("sim"), self.files("drawn"))
        for shard in "3/3", "1/3", "2/3":
            self.draw("air.lua", "parts", "--shard", shard, "--restore", "sim/%02d.state")
        self.assertEqual(self.files("parts"), self.files("whole"))

        self.write("sim/08.state", self.read("sim/08.state")[:5000])
        done = self.run_program("render", "air.lua", *SMALL, "--frames", "9", "-o", "nine.png", "--restore", "sim/%02d.state")
        self.assertEqual(done.returncode, 0)
        self.assertIn("08.state", done.stderr)
        self.assertIn("the one before is tried", done.stderr)
        self.assertEqual(self.read("nine.png"), self.read("whole/09.png"))

        self.succeeds("render", "air.lua", *SMALL, "--frames", "1-6", "--simulate-only", "--checkpoint", "chain/%02d.state",
                      "--checkpoint-every", "4", "--restore", "chain/%02d.state")
        said = self.succeeds("render", "air.lua", *SMALL, "--simulate-only", "--checkpoint", "chain/%02d.state",
                             "--checkpoint-every", "4", "--restore", "chain/%02d.state")
        self.assertIn("6 frames were there", said)
        self.assertEqual(self.read("chain/12.state"), self.read("drawn/12.state"))
        said = self.succeeds("render", "air.lua", *SMALL, "--simulate-only", "--checkpoint", "chain/%02d.state",
                             "--restore", "chain/%02d.state")
        self.assertIn("12 frames were there", said)

    def test_killed_anywhere_it_goes_on(self):
        self.draw("air.lua", "whole")
        draw = ["render", "air.lua", "-o", "killed/%02d.png", *SMALL, "--skip-existing", "--checkpoint", "killed.state",
                "--checkpoint-every", "1"]
        job = subprocess.Popen([PROGRAM, *draw], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while job.poll() is None and not os.path.exists(self.path("killed/03.png")):
            time.sleep(0.002)
        job.send_signal(signal.SIGKILL)
        job.wait()
        self.succeeds(*draw)
        self.assertEqual(self.files("killed"), self.files("whole"))

    def test_usage(self):
        for says, *arguments in (
                ("--shard '3/2'; accepted: 2/4", "--shard", "3/2"), ("--shard '0/2'", "--shard", "0/2"),
                ("--shard 'x'", "--shard", "x"), ("--checkpoint-every: where to?", "--checkpoint-every", "2"),
                ("--checkpoint-every -1", "--checkpoint-every", "-1", "--checkpoint", "a"),
                ("leaves nothing without --checkpoint", "--simulate-only"),
                ("draws no pictures: leave out -o", "--simulate-only", "--checkpoint", "a", "-o", "a.png"),
                ("a film is not drawn in parts", "--shard", "1/2", "-o", "a.mp4"),
                ("a film is not drawn in parts", "--skip-existing", "-o", "a.mp4"),
                ("accepted: one number in it", "--checkpoint", "%s.state")):
            self.fails(2, says, "render", "air.lua", *arguments)
        self.fails(1, "nothing in it simulates", "render", "puff.lua", "--simulate-only", "--checkpoint", "a.state", *SMALL)


if __name__ == "__main__":
    main()
