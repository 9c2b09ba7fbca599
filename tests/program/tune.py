"""`roil tune` on an effect whose best settings are known beforehand."""
import json
import math
import os
import signal
import subprocess
import time

from lib.program import PROGRAM, Case, main

# Work in proportion to `steps`, and a grey that is off by a part that falls with them.
EFFECT = """
local fx = effect { name = "known", fps = 24, frames = 12 }
local steps = param { "steps", 64, min = 1, max = 1024, integer = true, help = "of work" }
local look = param { "look", 0.5, min = 0, max = 1, help = "no matter of quality" }
fx.camera = orbit { target = {0, 0, 0}, distance = 3 }
local picture = shader { "known.comp", steps = steps, look = look }
fx.output = final { picture, tonemap = "none" }.color
return fx
"""
SHADER = """// A grey whose error is known, for known work.
uniform int steps;   //= 64 [1, 1024] : turns of the loop
uniform float look;  //= 0.5 [0, 1] : brightness
writeonly uniform image2D color; //= output rgba16f : grey
#include "lib/frame.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color)))) return;
    float x = float(pixel.x);
    for (int i = 0; i < steps * 160; i++) x = fract(sin(x) * 43758.5453 + float(i));
    imageStore(color, pixel, vec4(vec3(0.4 * look + 1.0 / float(steps) + min(x, 0.0)), 1.0));
}
"""
LADDER = (8, 16, 32, 64, 128, 256)
AXES = ["--axes", "steps=" + ":".join(str(v) for v in LADDER)]
QUICK = ["--size", "64x36", "--frames", "5", "--repeats", "1", "-o", "out"]


def shown(steps):
    grey = 0.2 + 1 / steps
    return round(255 * (1.055 * grey ** (1 / 2.4) - 0.055))


def psnr(steps):
    off = abs(shown(steps) - shown(LADDER[-1])) / 255
    return -20 * math.log10(off) if off else math.inf


class Tune(Case):
    def setUp(self):
        super().setUp()
        self.write("known.lua", EFFECT)
        self.write("known.comp", SHADER)

    def rows(self):
        return json.loads(self.read("out/results.json"))["rows"]

    def chosen(self):
        content = json.loads(self.read("out/results.json"))
        return next(r for r in content["rows"] if r["index"] == content["tuned"]["chosen"])

    def milliseconds(self, row):
        content = json.loads(self.read("out/results.json"))
        if content["tuned"]["by_process"]:
            return row["cpu_ms"]["process"]["median"] / content["machine"]["cores"]
        return row["gpu_ms"]["all"]["median"]

    def test_the_least_time_within_an_error(self):
        for wanted in (16, 32):  # down from 64, as far as the error allows
            limit = psnr(wanted) - 0.5
            self.assertLess(psnr(wanted // 2), limit)
            told = self.succeeds("tune", "known.lua", "--max-error", f"{limit}", "--error", "psnr", *AXES, *QUICK)
            row = self.chosen()
            self.assertEqual(row["axes"], {"steps": str(wanted)})
            self.assertAlmostEqual(row["error"]["psnr"], psnr(wanted), places=3)
            self.assertRegex(told, rf"steps +64 +{wanted}\n")
            self.assertEqual(self.read("known.presets/tuned.lua").decode().splitlines()[1:],
                             ["return {", f"  steps = {wanted},", "}"])
        self.succeeds("render", "known.lua", "--preset", "tuned", "--frames", "1", "-o", "x.png", "--size", "8x8")

    def test_up_to_where_the_error_is_kept(self):
        self.succeeds("tune", "known.lua", "--max-error", f"{psnr(128) - 0.5}", "--error", "psnr", "--set", "steps=8",
                      *AXES, *QUICK)
        self.assertEqual(self.chosen()["axes"], {"steps": "128"})

    def test_values_beside_what_the_effect_has(self):
        self.succeeds("tune", "known.lua", "--max-ms", "1e9", "--axes", "steps=16:32", *QUICK)
        first = self.rows()[0]
        self.assertEqual(first["axes"], {"steps": "32"})
        self.assertEqual(first["settings"], {"steps": "32"})

    def test_the_best_within_a_time(self):
        # All rungs are measured once; then the answer follows from what was noted.
        self.succeeds("tune", "known.lua", "--max-ms", "1e9", *AXES, *QUICK)
        self.assertEqual(self.chosen()["axes"], {"steps": "256"})
        self.fails(3, ["cannot be kept", "no preset"], "tune", "known.lua", "--max-ms", "1e-6", "--resume",
                   "--name", "none", *AXES, *QUICK)
        self.assertFalse(os.path.exists(self.path("known.presets/none.lua")))
        cost = {int(r["axes"]["steps"]): self.milliseconds(r) for r in self.rows()}
        for wanted in (32, 64, 128):
            limit = 1.2 * cost[wanted]
            self.assertLess(limit, cost[2 * wanted])
            self.succeeds("tune", "known.lua", "--max-ms", f"{limit:.9g}", "--resume", *AXES, *QUICK)
            self.assertEqual(self.chosen()["axes"], {"steps": str(wanted)})
        self.assertEqual(len(self.rows()), len(cost))

    def test_what_an_effect_has(self):
        told = self.succeeds("tune", "known.lua", "--max-ms", "1e9", "--budget", "0.001", *QUICK)
        self.assertRegex(told, r"steps: 8 12 16 24 32 48 \[64\] 96 128 256\n")
        self.assertNotIn("look", told)
        self.assertIn("--resume goes on", told)
        self.assertEqual(len(self.rows()), 1)
        page = self.read("out/report.html").decode()
        self.assertIn("What was found", page)

    def test_interrupted_and_resumed(self):
        with subprocess.Popen([PROGRAM, "tune", "known.lua", "--max-error", "0", *AXES, *QUICK], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
            until = time.monotonic() + 60
            while not os.path.exists(self.path("out/rows/0001.png")) and time.monotonic() < until:
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
        before = self.rows()
        self.assertGreaterEqual(len(before), 1)
        told = self.succeeds("tune", "known.lua", "--max-error", "0", "--resume", *AXES, *QUICK)
        self.assertIn("kept", told)
        self.assertEqual(self.rows()[:len(before)], before)
        self.assertEqual(self.chosen()["error"]["flip"], 0)

    def test_results_of_something_else_are_not_taken(self):
        self.succeeds("tune", "known.lua", "--max-ms", "1e9", "--budget", "0.001", *AXES, *QUICK)
        self.write("known.lua", EFFECT + "-- edited\n")
        self.fails(1, "of another effect", "tune", "known.lua", "--max-ms", "1e9", "--resume", *AXES, *QUICK)

    def test_mistakes(self):
        self.fails(2, "--max-ms MS", "tune", "known.lua")
        self.fails(2, "--max-ms MS", "tune", "known.lua", "--max-ms", "1", "--max-error", "1")
        self.fails(2, "accepted: 0 to 1", "tune", "known.lua", "--max-error", "2")
        self.fails(2, "accepted: flip, psnr", "tune", "known.lua", "--max-error", "0.1", "--error", "ssim")
        self.fails(2, "which effect", "tune", "--max-ms", "1")
        self.fails(1, ["--axes", "did you mean 'steps'"], "tune", "known.lua", "--max-ms", "1", "--axes", "stesp")
        self.fails(1, "two values at least", "tune", "known.lua", "--max-ms", "1", "--axes", "steps=4")
        self.fails(1, "absent.lua", "tune", "absent.lua", "--max-ms", "1")
        self.write("plain.lua", EFFECT.replace('"steps", 64', '"turns", 64'))
        self.fails(1, "name some with --axes", "tune", "plain.lua", "--max-ms", "1")
        self.write("broken.comp", SHADER.replace("vec4(vec3(", "vec5(vec3("))
        self.write("broken.lua", EFFECT.replace("known.comp", "broken.comp"))
        self.fails(1, "vec5", "tune", "broken.lua", "--max-ms", "1", *QUICK)


if __name__ == "__main__":
    main()
