"""Sweeps: measured, interrupted, resumed, measured in parts, compared."""
import csv
import io
import json
import os
import re
import signal
import subprocess
import time

from lib.pictures import Png
from lib.program import PROGRAM, SECONDS, Case, main

PUFF = """
local fx = effect { name = "puff", fps = 24, frames = 10 }
local thickness = param { "thickness", 4, min = 0, max = 100 }
local steps = param { "steps", 8, min = 2, max = 64, integer = true }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 10 }
local ball = sphere { position = {0, 0, 1}, radius = 1, falloff = 0.5 }
local volume = march { density = ball * perlin { frequency = 2 } * thickness, emission = {0.4, 0.1, 0}, steps = steps, shadow_steps = 2 }
fx.output = final { volume.color }.color
return fx
"""

SWEEP = """
return sweep {
  name = "try", title = "A try", notes = { "of a puff" }, effect = "puff.lua", size = {96, 54}, frames = "3-5", settle = 0,
  axes = { axis { "steps", 8, 16 }, axis { "thickness", 4, 40, label = "thick" } }, %s
}
"""


class Bench(Case):
    def setUp(self):
        super().setUp()
        self.write("puff.lua", PUFF)
        self.write("sweep.lua", SWEEP % "reference = { steps = 64 }")

    def results(self, folder="out"):
        return json.loads(self.read(f"{folder}/results.json"))

    def rows(self, folder="out"):
        return self.results(folder)["rows"]

    def bench(self, *args, **options):
        return self.succeeds("bench", "sweep.lua", "-o", "out", *args, **options)

    def test_a_sweep_is_measured(self):
        said = self.bench()
        self.assertIn("A try: 4 of 4 rows", said)
        self.assertIn("wrote out/results.json", said)
        for label in ("steps 8, thick 4", "steps 8, thick 40", "steps 16, thick 4", "steps 16, thick 40"):
            self.assertEqual(said.count(label + " "), 2, said)  # as it comes, and in the table
        all_of_it = self.results()
        self.assertEqual([a["name"] for a in all_of_it["axes"]], ["steps", "thickness"])
        self.assertEqual(all_of_it["reference"], {"kind": "row", "settings": {"steps": "64"}})
        self.assertEqual(all_of_it["notes"], ["of a puff"])
        self.assertTrue(all_of_it["device"] and all_of_it["driver"] and all_of_it["machine"]["cpu"])
        for row in all_of_it["rows"]:
            self.assertEqual(row["state"], "done", row["message"])
            self.assertEqual((row["width"], row["height"], row["frames"]), (96, 54, [3, 4, 5]))
            self.assertEqual(row["gpu_ms"]["march"]["count"], 3)
            whole = row["gpu_ms"]["all"]
            self.assertTrue(0 < whole["p5"] <= whole["median"] <= whole["p95"])
            self.assertLess(row["gpu_ms"]["march"]["median"], whole["median"])
            self.assertGreater(row["cpu_ms"]["frame"]["median"], 0)
            self.assertGreater(row["counters"]["march.samples"], 0)
            self.assertTrue(0 < row["memory"]["device"] <= row["memory"]["reserved"])
            self.assertGreater(row["memory"]["host"], 1 << 20)
            self.assertEqual(Png(self.read("out/" + row["thumbnail"])).width, 96)
        self.succeeds("render", "puff.lua", "--frames", "3", "-o", "a.png", "--size", "96x54")
        inputs = re.search(rb'"inputs":"([0-9a-f]{32})"', self.read("a.png"))[1].decode()
        self.assertEqual({row["inputs"] for row in all_of_it["rows"]}, {inputs})
        self.assertIn(f"<dt>Hash of all that it read</dt><dd>{inputs}</dd>", self.read("out/report.html").decode())
        coarse, fine = all_of_it["rows"][0], all_of_it["rows"][2]
        self.assertLess(coarse["counters"]["march.samples"], fine["counters"]["march.samples"])
        self.assertLess(coarse["error"]["psnr"], fine["error"]["psnr"])
        lines = list(csv.DictReader(io.StringIO(self.read("out/results.csv").decode())))
        self.assertEqual([line["axis.steps"] for line in lines], ["8", "8", "16", "16"])
        self.assertAlmostEqual(float(lines[0]["gpu.march.median"]), coarse["gpu_ms"]["march"]["median"], 4)

    def start(self, *args):
        return subprocess.Popen([PROGRAM, "bench", "sweep.lua", "-o", "out", *args], cwd=self.folder,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for_rows(self, count):
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            if os.path.exists(self.path("out/results.json")) and len(self.rows()) >= count:
                return
            time.sleep(0.02)
        self.fail("no row came")

    def test_an_interrupted_sweep_goes_on(self):
        self.write("sweep.lua", SWEEP % "repeats = 25")
        running = self.start()
        self.wait_for_rows(1)
        running.send_signal(signal.SIGINT)
        said = running.communicate(timeout=SECONDS)[1]
        self.assertEqual(running.returncode, 1, said)
        self.assertIn("--resume goes on", said)
        before = self.rows()
        self.assertTrue(0 < len(before) < 4)
        self.write("sweep.lua", (SWEEP % "repeats = 25") + "-- the same, said otherwise\n")
        self.assertIn(f"{4 - len(before)} of 4 rows", self.bench("--resume"))
        self.assertEqual(self.rows()[:len(before)], before)
        self.assertEqual([row["index"] for row in self.rows()], [0, 1, 2, 3])
        self.fails(1, "is of another sweep", "bench", "sweep.lua", "-o", "out", "--resume", "--repeats", "2")
        self.write("puff.lua", PUFF.replace("radius = 1", "radius = 1.1"))
        self.fails(1, "is of another sweep", "bench", "sweep.lua", "-o", "out", "--resume")

    def test_parts_are_merged_and_compared(self):
        for part in ("1/2", "2/2"):
            self.succeeds("bench", "sweep.lua", "-o", "part-" + part[0], "--shard", part)
        self.assertEqual([row["index"] for row in self.rows("part-2")], [1, 3])
        said = self.succeeds("bench", "--merge", "part-2", "part-1", "-o", "out", "--baseline", "part-1",
                             "--strict")
        self.assertIn("0 rows slower, 0 faster", said)
        self.assertEqual(self.rows(), sorted(self.rows("part-1") + self.rows("part-2"), key=lambda row: row["index"]))
        self.assertTrue(all(os.path.exists(self.path("out/" + row["thumbnail"])) for row in self.rows()))
        faster = self.results()
        for row in faster["rows"]:
            for figure in row["gpu_ms"].values():
                for key in ("median", "p5", "p95"):
                    figure[key] /= 100
        self.write("fast.json", json.dumps(faster))
        done = self.run_program("bench", "--merge", "out", "-o", "out", "--baseline", "fast.json", "--strict")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("4 rows slower", done.stdout)
        self.assertIn("4 rows are slower than in fast.json", done.stderr)

    def test_rows_are_chosen_and_listed(self):
        listed = self.succeeds("bench", "sweep.lua", "--list", "--only", "thick=40").splitlines()
        self.assertEqual(listed, ["steps 8, thick 40", "steps 16, thick 40"])
        self.bench("--rows", "steps 16, *", "--only", "thickness=4", "--size", "48x27", "--frames", "2")
        row, = self.rows()
        self.assertEqual((row["index"], row["width"], row["frames"]), (2, 48, [2]))

    def test_a_row_that_fails_does_not_end_the_sweep(self):
        self.write("sweep.lua", (SWEEP % "").replace("8, 16", "8, 9999"))
        self.fails(1, "2 of 4 rows failed", "bench", "sweep.lua", "-o", "out")
        self.assertEqual([row["state"] for row in self.rows()], ["done", "done", "failed", "failed"])
        self.assertIn("steps", self.rows()[2]["message"])

    def test_a_row_that_takes_too_long_is_stopped(self):
        self.bench("--limit", "0.001", "--repeats", "1000", "--only", "steps=8")
        for row in self.rows():
            self.assertEqual(row["state"], "limit")
            self.assertIn("0.001 s", row["message"])

    def test_a_path_traced_reference(self):
        self.write("sweep.lua", SWEEP % "reference = { samples = 4, steps = 8 }")
        self.bench("--size", "24x14", "--frames", "3")
        self.assertEqual(self.results()["reference"]["kind"], "traced")
        self.assertTrue(all("error" in row for row in self.rows()))
        pictures = os.listdir(self.path("out/reference"))
        self.assertEqual(len(pictures), 2)  # one for each thickness

    def test_reloads_and_starts(self):
        self.write("reload.lua", 'return sweep { name = "r", effect = "puff.lua", size = {48, 27}, measure = "reload", '
                   'repeats = 2, axes = { axis { "edit", { name = "number", edit = {"radius = 1", "radius = 1.1", '
                   '"radius = 1.2"} }, { name = "none", edit = {"no such text", ""} } } } }')
        self.fails(1, "1 of 2 rows failed", "bench", "reload.lua", "-o", "out")
        number, none = self.rows()
        self.assertEqual(number["times_ms"]["reload"]["count"], 2)
        self.assertLess(number["times_ms"]["take_over"]["median"], number["times_ms"]["reload"]["median"])
        self.assertIn("has no text 'no such text'", none["message"])
        self.write("start.lua", 'return sweep { name = "s", effect = "puff.lua", measure = "start", repeats = 1, '
                   'warmup = 0, axes = { axis { "cache", "warm", "empty" } } }')
        self.succeeds("bench", "start.lua", "-o", "out")
        self.assertTrue(all(row["times_ms"]["start"]["median"] > 1 for row in self.rows()))

    def test_mistakes_are_told(self):
        self.write("sweep.lua", (SWEEP % "").replace('"thickness"', '"thicknes"'))
        self.fails(1, ["thicknes", "did you mean 'thickness'?"], "bench", "sweep.lua", "-o", "out")
        self.assertFalse(os.path.exists(self.path("out/results.json")))
        self.write("sweep.lua", SWEEP % "repats = 3")
        self.fails(1, ["sweep.lua:", "did you mean 'repeats'?"], "bench", "sweep.lua", "-o", "out")
        self.fails(2, "which sweep?", "bench")
        self.fails(2, "--shard '3/2'", "bench", "sweep.lua", "--shard", "3/2")
        self.fails(2, "--only 'steps'", "bench", "sweep.lua", "--only", "steps")
        self.fails(2, "usage: roil bench --merge", "bench", "--merge", "out")
        self.fails(2, "frames 'x'", "bench", "sweep.lua", "--frames", "x")
        self.fails(1, "none.lua", "bench", "none.lua")


main()
