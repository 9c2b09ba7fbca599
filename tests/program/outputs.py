"""What is written: pictures, video, statistics; and what happens when it cannot be."""
import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from lib.pictures import Exr, Png, packed_pixels
from lib.program import DATA, GROUND, PROGRAM, PUFF, SMALL, SOURCE, VOLUME, Case, main

BALL = VOLUME % "sphere { position = {1, 1, 1}, radius = 1 } * 10"

GREY = """// The same everywhere.
uniform float value; //= 0 [0, 1] : linear
writeonly uniform image2D color; //= output rgba32f : grey
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(color)))) imageStore(color, pixel, vec4(vec3(value), 1.0));
}
"""
GLOW = """// Light that is brighter than what covers it.
writeonly uniform image2D color; //= output rgba16f : premultiplied
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(color)))) imageStore(color, pixel, vec4(0.5, 0.25, 0.0625, 0.125));
}
"""
GLOWS = """
local fx = effect { name = "glows", fps = 24, frames = 2 }
fx.camera = orbit { target = {0, 0, 0}, distance = 3 }
local shown = final { shader { "glow.comp" }, tonemap = "none" }
fx.output, fx.linear = shown.color, shown.linear
return fx
"""
FLAT = """
local fx = effect { name = "flat", fps = 24, frames = 2 }
fx.camera = orbit { target = {0, 0, 0}, distance = 3 }
fx.output = final { shader { "grey.comp", value = %.9f }, tonemap = "none", format = "rgba32f" }.color
return fx
"""


class Pictures(Case):
    def png(self, name="out.png"):
        return Png(self.read(name))

    def test_png_is_opaque_unless_asked(self):
        self.render(BALL)
        picture = self.png()
        self.assertEqual((picture.width, picture.height), (96, 54))
        self.assertEqual((picture.channels, picture.bits), (3, 8))
        self.assertEqual(picture.rows[0][:3], (0, 0, 0))
        self.assertGreater(max(picture.channel(0)), 20)

    def test_png_between_two_codes_has_both(self):
        self.write("grey.comp", GREY)
        for code in (3.25, 50.5, 200):  # of sRGB
            linear = ((code / 255 + 0.055) / 1.055) ** 2.4 if code > 11 else code / 255 / 12.92
            self.render(FLAT % linear, "-s", "128x128")
            seen = self.png().channel(1)
            self.assertLessEqual({*seen}, {int(code), int(code) + 1})
            self.assertAlmostEqual(sum(seen) / len(seen), code, delta=0.05)
            self.render(FLAT % linear, "-s", "128x128", output="again.png")
            self.assertEqual(self.read("out.png"), self.read("again.png"))

    def test_png_keeps_alpha(self):
        self.render(BALL, "--alpha")
        picture = self.png()
        alpha = picture.channel(3)
        self.assertEqual(picture.channels, 4)
        self.assertEqual(alpha[0], 0)
        self.assertGreater(alpha[27 * 96 + 48], 250)
        self.assertTrue(any(20 < a < 235 for a in alpha))

    def test_light_over_little_cover_stays_whole_premultiplied(self):
        self.write("glow.comp", GLOW)
        self.render(GLOWS, "--16", "--premultiplied")
        picture = self.png()
        self.assertEqual(picture.channels, 4)
        self.assertAlmostEqual(picture.channel(0)[0] / 65535, 1.055 * 0.5 ** (1 / 2.4) - 0.055, places=3)
        self.assertAlmostEqual(picture.channel(3)[0] / 65535, 0.125, places=3)
        self.render(GLOWS, "--16", "--alpha")
        self.assertEqual(self.png().channel(0)[0], 65535)
        self.assertAlmostEqual(self.png().channel(2)[0] / 65535, 1.055 * 0.5 ** (1 / 2.4) - 0.055, places=3)
        self.fails(2, "one of the two", "render", "effect.lua", "--alpha", "--premultiplied")

    def test_exr_of_what_is_shown(self):
        self.write("glow.comp", GLOW)
        tone_mapped = GLOWS.replace('"none"', '"exponential"')
        for arguments, red in (((), 0.5), (("--shown",), 1 - 2.718281828 ** -0.5)):
            self.render(tone_mapped, *arguments, output="out.exr")
            picture = Exr(self.read("out.exr"))
            self.assertAlmostEqual(picture.channels["R"][0], red, delta=1e-3)
            self.assertAlmostEqual(picture.channels["A"][0], 0.125, delta=1e-3)

    def test_png_of_sixteen_bits(self):
        self.render(BALL)
        rough = self.png().channel(1)
        self.render(BALL, "--16", "--alpha")
        picture = self.png()
        self.assertEqual((picture.channels, picture.bits), (4, 16))
        self.assertGreater(len(set(picture.channel(1))), len(set(rough)))
        self.render(BALL, "--16")
        fine = self.png().channel(1)
        self.assertTrue(all(abs(f / 257 - r) <= 1 for f, r in zip(fine, rough)))

    def test_exr_is_linear_with_alpha_and_depth(self):
        self.render(PUFF, output="out.exr")
        picture = Exr(self.read("out.exr"))
        self.assertEqual((picture.width, picture.height), (96, 54))
        self.assertEqual(picture.types, {"A": 1, "B": 1, "G": 1, "R": 1, "Z": 2})
        depth = picture.channels["Z"]
        self.assertLess(depth[53 * 96 + 48], 20)  # the ground before the camera
        self.assertGreater(depth[48], depth[53 * 96 + 48])  # the sky is further
        self.assertEqual(min(picture.channels["A"]), 1)
        self.render(PUFF, "--float", output="out.exr")
        full = Exr(self.read("out.exr"))
        self.assertEqual(set(full.types.values()), {2})
        close = [abs(a - b) <= 0.001 * abs(b) + 1e-6
                 for a, b in zip(picture.channels["R"], full.channels["R"])]
        self.assertTrue(all(close))

    def test_exr_without_depth(self):
        self.render(BALL, output="out.exr")
        picture = Exr(self.read("out.exr"))
        self.assertEqual(sorted(picture.types), ["A", "B", "G", "R"])
        self.assertEqual(picture.channels["A"][0], 0)
        self.assertGreater(max(picture.channels["A"]), 0.95)

    def test_frames_are_numbered(self):
        self.render(PUFF, "--frames", "1-5:2,9", output="deep/folder/f%03d.png")
        self.assertEqual(sorted(os.listdir(self.path("deep/folder"))),
                         ["f001.png", "f003.png", "f005.png", "f009.png"])

    def test_default_output_is_named_after_the_effect(self):
        self.write("puff.lua", PUFF)
        self.assertIn("wrote out/puff/%04d.png",
                      self.succeeds("render", "puff.lua", "--frames", "2", *SMALL))
        self.assertTrue(os.path.exists(self.path("out/puff/0002.png")))

    def test_all_frames_are_the_default(self):
        self.write("effect.lua", 'local fx = effect { name = "four", frames = 4, first = 7 }\n'
                   "fx.output = geometry {}\n")
        self.succeeds("render", "effect.lua", "-o", "%d.png", *SMALL)
        self.assertEqual(sorted(n for n in os.listdir(self.folder) if n.endswith(".png")),
                         ["10.png", "7.png", "8.png", "9.png"])

    def test_same_frame_is_the_same_bit_for_bit(self):
        self.render(PUFF, output="a.png")
        self.render(PUFF, output="b.png")
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        self.render(PUFF, "--frames", "3,2,1", "--no-cache", output="c%d.png")
        self.assertEqual(self.read("c1.png"), self.read("a.png"))  # whatever came before

    def test_frames_before_can_be_drawn_for_what_remembers_them(self):
        gathered = """
local fx = effect { name = "gathered", frames = 10 }
fx.camera = orbit { target = {1, 1, 1}, distance = 6 }
local volume = march { density = sphere { position = {1, 1, 1}, radius = 1, falloff = 1 } * 3, steps = 4, jitter = 1 }
fx.output = final { accumulate { from = volume, source = volume.color } }.color
return fx
"""
        self.render(gathered, "--frames", "3-6", output="a%d.png")
        self.render(gathered, "--frames", "6", output="alone.png")
        self.render(gathered, "--frames", "1,6", "--warmup", "3", output="b%d.png")
        self.assertEqual(self.read("a6.png"), self.read("b6.png"))
        self.assertNotEqual(packed_pixels(self.read("a6.png")), packed_pixels(self.read("alone.png")))
        self.fails(2, "--warmup -1", "render", "effect.lua", "--warmup", "-1")

    def test_odd_sizes(self):
        self.write("effect.lua", PUFF)
        for size in ("1x1", "7x3", "3x100"):
            with self.subTest(size):
                self.succeeds("render", "effect.lua", "--frames", "1", "-o", "out.png", "--size", size)
                picture = self.png()
                self.assertEqual(f"{picture.width}x{picture.height}", size)

    def test_image_of_a_pass_is_dumped(self):
        self.render(PUFF, "--dump-pass", "march", "march.exr", "--dump-pass", "geometry.depth",
                    "depth.exr")
        march, depth = Exr(self.read("march.exr")), Exr(self.read("depth.exr"))
        self.assertGreater(max(march.channels["A"]), 0.5)
        self.assertLess(min(march.channels["A"]), 0.01)
        self.assertGreater(min(depth.channels["R"]), 1)
        self.assertTrue(os.path.exists(self.path("out.png")))
        self.fails(1, "no image 'marsh'; did you mean 'march'?", "render", "effect.lua", "--frames", "1",
                   "--dump-pass", "marsh", "a.exr")
        self.fails(1, ["march.colour", "march.color"], "render", "effect.lua", "--frames", "1",
                   "--dump-pass", "march.colour", "a.exr")


class Video(Case):
    def test_video_has_every_frame(self):
        self.render(PUFF, "--frames", "1-7", output="out.mp4")
        if not shutil.which("ffprobe"):
            self.skipTest("ffprobe is not installed")
        told = subprocess.run(
            ["ffprobe", "-v", "error", "-count_frames", "-show_entries",
             "stream=nb_read_frames,width,height,r_frame_rate", "-of", "json", self.path("out.mp4")],
            stdout=subprocess.PIPE, check=True)
        self.assertEqual(json.loads(told.stdout)["streams"],
                         [{"width": 96, "height": 54, "r_frame_rate": "24/1", "nb_read_frames": "7"}])

    def decoded(self, name, *decoder):
        """Red, green, blue and alpha of every pixel of a film's first frame, and its size."""
        told = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of", "csv=p=0", self.path(name)],
                              stdout=subprocess.PIPE, check=True, text=True)
        data = subprocess.run(["ffmpeg", "-v", "error", *decoder, "-i", self.path(name), "-frames:v", "1", "-f", "rawvideo",
                               "-pix_fmt", "rgba", "-"], stdout=subprocess.PIPE, check=True)
        return data.stdout, [int(v) for v in told.stdout.split(",")[:2]]

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_films_keep_alpha(self):
        self.write("effect.lua", VOLUME % "2 * sphere { position = {1, 1, 1}, radius = 0.7, falloff = 0.02 }")
        films = [part for kind in ("webm", "mov", "gif", "apng") for part in ("-o", "film." + kind)]
        self.succeeds("render", "effect.lua", "--frames", "1-3", "--alpha", "-s", "97x55", *films, "-o", "%d.png",
                      "--set", "march.albedo=1,1,1", "--set", "sun.strength=20", "--set", "march.shadow_steps=0")
        wanted = Png(self.read("1.png"))
        opacity = wanted.channel(3)
        self.assertGreater(max(opacity), 200)
        for name, decoder, size, slack in (("film.webm", ["-c:v", "libvpx-vp9"], [98, 56], 6), ("film.mov", [], [97, 55], 2),
                                           ("film.apng", [], [97, 55], 0), ("film.gif", [], [97, 55], 40)):
            data, seen = self.decoded(name, *decoder)
            self.assertEqual(seen, size, name)
            at = [4 * (y * size[0] + x) for y in range(55) for x in range(97)]
            apart = sum(abs(data[i + 3] - a) for i, a in zip(at, opacity)) / len(at)
            self.assertLessEqual(apart, slack, name)
            middle = 4 * (27 * size[0] + 48)
            for c in range(3):
                mean = sum(data[middle + c + 4 * (x + y * size[0])] for x in range(-4, 4) for y in range(-4, 4)) / 64
                self.assertAlmostEqual(mean, wanted.rows[27][48 * 4 + c], delta=12, msg=(name, c))
        self.assertEqual(subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream_tags=alpha_mode", "-of", "csv=p=0",
                                         self.path("film.webm")], stdout=subprocess.PIPE, check=True, text=True).stdout.strip(), "1")
        self.fails(1, "keeps no alpha; .webm, .mov", "render", "effect.lua", "--frames", "1", "--alpha", "-o", "film.mp4", *SMALL)

    def test_unfinished_video_is_removed(self):
        effect = PUFF.replace("return fx", """
fx.update = function(t) if t > 0.1 then error("too late") end end
return fx""")
        self.write("effect.lua", effect)
        self.fails(1, "too late", "render", "effect.lua", "-o", "out.mp4", *SMALL)
        self.assertEqual(sorted(os.listdir(self.folder)), ["effect.lua", "ground.obj"])


class Unwritable(Case):
    """What cannot be written is said before the first frame, which this effect would take too long to draw."""
    SLOW = PUFF.replace("return fx", "fx.update = function() error('drawn') end\nreturn fx")

    def test_it_is_said_before_the_work(self):
        self.write("effect.lua", self.SLOW)
        self.write("file", "")
        shutil.copy(os.path.join(DATA, "nan.vdb"), self.path("a.vdb"))
        render = ["render", "effect.lua", "--frames", "1-2", *SMALL]
        for arguments in (
                [*render, "-o", "file/%d.png"], [*render, "-o", "file/a.mp4"], [*render, "-o", "file/%d.exr"],
                [*render, "-o", "%d.png", "--stats", "file/a.json"], [*render, "-o", "%d.png", "--checkpoint", "file/a"],
                ["export", "vdb", "effect.lua", "--frames", "1-2", "-o", "file/%d.vdb"],
                ["export", "raw", "a.vdb", "-o", "file/a.raw"], ["bench", "sweep.lua", "-o", "file/a"]):
            self.write("sweep.lua", 'return sweep { name = "a", effect = "effect.lua", size = {32, 18}, frames = "1" }')
            with self.subTest(arguments):
                self.assertNotIn("drawn", self.fails(1, "file", *arguments))
                self.assertEqual(sorted(os.listdir(self.folder)),
                                 ["a.vdb", "effect.lua", "file", "ground.obj", "sweep.lua"])

    def test_films_are_files(self):
        self.write("effect.lua", PUFF)
        os.symlink("/dev/null", self.path("null.mp4"))
        self.fails(1, "no regular file", "render", "effect.lua", "--frames", "1", "-o", "null.mp4", *SMALL)
        self.assertTrue(os.path.islink(self.path("null.mp4")))


class Stopped(Case):
    def test_nothing_is_left_of_a_film(self):
        self.write("effect.lua", PUFF.replace("frames = 10", "frames = 100000"))
        before = sorted(os.listdir(self.folder))
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL:
            with self.subTest(signal=number):
                child = subprocess.Popen([PROGRAM, "render", "effect.lua", *SMALL, "-o", "out.mp4"], cwd=self.folder,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                child.stderr.read(1)  # of the progress: frames are being drawn
                child.send_signal(number)
                child.communicate(timeout=60)
                self.assertEqual(sorted(os.listdir(self.folder)), before)
                self.assertEqual(child.returncode, -number if number == signal.SIGKILL else 1)


    def test_nothing_is_left_of_pictures(self):
        self.write("effect.lua", PUFF.replace("frames = 10", "frames = 100000"))
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGKILL:
            with self.subTest(signal=number):
                child = subprocess.Popen([PROGRAM, "render", "effect.lua", *SMALL, "-o", "shots/%06d.png"], cwd=self.folder,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                child.stderr.read(1)
                child.send_signal(number)
                child.communicate(timeout=60)
                for name in os.listdir(self.path("shots")):
                    self.assertRegex(name, r"^\d{6}\.png$")
                    Png(self.read("shots/" + name))  # whole

    def test_nothing_is_left_of_a_sweep(self):
        self.write("fx/effect.lua", PUFF + "-- one\n")
        self.write("fx/ground.obj", GROUND)
        os.mkdir(self.path("tmp"))
        # The validation layers keep a file beside the user's other caches, or in TMPDIR where there are none.
        temporary = {"TMPDIR": self.path("tmp"), "XDG_CACHE_HOME": self.folder}
        sweep = ('return sweep { name = "try", effect = "fx/effect.lua", size = {32, 18}, frames = "3", measure = "reload",\n'
                 'repeats = %d, warmup = 0, axes = { axis { "edit", { name = "a", edit = {"-- one", "-- two", "-- three"} } } } }')
        self.write("sweep.lua", sweep % 1)
        self.succeeds("bench", "sweep.lua", "-o", "out", environment=temporary)
        self.assertEqual(os.listdir(self.path("tmp")), [])
        self.write("sweep.lua", sweep % 10000)
        child = subprocess.Popen([PROGRAM, "bench", "sweep.lua", "-o", "out"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True, env={**os.environ, **temporary})
        end = time.monotonic() + 60
        while not os.listdir(self.path("tmp")) and child.poll() is None and time.monotonic() < end:
            time.sleep(0.01)  # nothing tells of a folder that is made
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=60)
        self.assertEqual(child.returncode, 1)
        self.assertEqual(os.listdir(self.path("tmp")), [])


class Statistics(Case):
    def test_statistics_hold_times_samples_and_the_machine(self):
        printed = self.render(PUFF, "--frames", "1-3", "--stats", "s/stats.json", "--set", "steps=9",
                              output="%d.png")
        stats = json.loads(self.read("s/stats.json"))
        for key in ("roil", "effect", "device", "driver"):
            self.assertTrue(stats[key], key)
        self.assertEqual((stats["width"], stats["height"], stats["set"]), (96, 54, {"steps": "9"}))
        self.assertEqual([f["frame"] for f in stats["frames"]], [1, 2, 3])
        for frame in stats["frames"]:
            self.assertEqual(set(frame["gpu_ms"]), {"geometry", "shade", "march.bricks", "march", "over", "final"})
            self.assertTrue(all(ms >= 0 for ms in frame["gpu_ms"].values()))
            self.assertGreater(frame["gpu_ms"]["march"], 0)
            self.assertGreater(frame["counters"]["march.samples"], 1000)
        self.assertEqual(set(stats["median_gpu_ms"]), {"geometry", "shade", "march.bricks", "march", "over", "final", "all"})
        for name in ("geometry", "shade", "march", "over", "final"):
            self.assertIn(name, printed)

    def test_statistics_tell_how_sequences_play(self):
        shutil.copytree(os.path.join(SOURCE, "effects", "data", "explosion-32"), self.path("burst"))
        effect = 'local burst = vdb { "burst/*.vdb", storage = "sparse" }\n' + VOLUME % "burst.density"
        printed = self.render(effect, "--frames", "1-4", "--stats", "stats.json", output="%d.png")
        self.assertRegex(printed, r"sequences: 4 frames shown, [\d.]+ a second")
        played = json.loads(self.read("stats.json"))["sequences"]
        self.assertEqual((played["shown"], played["late"]), (4, 0))
        self.assertLess(played["frame_bytes"], 32 ** 3 * 10)
        self.assertGreater(played["frame_bytes"], 2 * played["frame_voxels"])
        self.assertGreater(played["frame_voxels"], 0)
        self.assertGreater(played["device_bytes"], 0)

    def test_more_steps_take_more_samples(self):
        samples = []
        for steps in ("8", "32"):
            self.render(PUFF, "--stats", "stats.json", "--set", f"steps={steps}")
            samples.append(json.loads(self.read("stats.json"))["frames"][0]["counters"]["march.samples"])
        self.assertGreater(samples[1], 2 * samples[0])

    def test_a_noise_that_takes_most_of_the_time_is_named(self):
        for made in ("", ":tile()"):
            effect = VOLUME.replace("distance = 6", "distance = 3") % f"sphere {{ position = {{1, 1, 1}} }} * worley {{ octaves = 3 }}{made}"
            printed = self.render(effect, "--frames", "1-2", "--stats", "stats.json", "--set", "march.steps=256",
                                  "--set", "march.early_exit=0", output="%d.png")
            slow = json.loads(self.read("stats.json")).get("slow")
            self.assertEqual(slow is None, bool(made), slow)
            if slow:
                self.assertRegex(slow, r"^march takes \d+ %: worley with 3 octaves is evaluated up to [\d.]+ million times; `:tile\(\)` evaluates it")
                self.assertIn(slow, printed)


def small_disk():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # writing fails instead, as on a full disk
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))


class Trouble(Case):
    def test_unwritable_folder(self):
        self.write("effect.lua", PUFF)
        self.write("file", "")
        for output in ("file/out.png", "/proc/roil/out.png"):
            self.fails(1, os.path.dirname(output), "render", "effect.lua", "--frames", "1", "-o", output,
                       *SMALL)
        os.makedirs(self.path("taken.png"))
        self.fails(1, "taken.png: is a folder", "render", "effect.lua", "--frames", "1", "-o",
                   "taken.png", *SMALL)
        self.fails(1, "file", "render", "effect.lua", "-o", "file/out.mp4", *SMALL)
        self.fails(1, "file", "render", "effect.lua", "--frames", "1", "-o", "out.png", *SMALL, "--stats",
                   "file/s.json")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_forbidden_folder(self):
        self.write("effect.lua", PUFF)
        os.makedirs(self.path("closed"), mode=0o500)
        self.fails(1, ["closed", "Permission denied"], "render", "effect.lua", "--frames", "1", "-o",
                   "closed/out.png", *SMALL)

    def test_full_disk(self):
        self.render(PUFF, output="old.png")  # also compiles: the compiler needs room of its own
        before = sorted(os.listdir(self.folder))
        for output in ("out.png", "out.exr", "out.mp4"):
            with self.subTest(output):
                self.fails(1, [output, "File too large"], "render", "effect.lua", "--frames", "1",
                           "-o", output, *SMALL, before=small_disk)
                self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_full_disk_does_not_spoil_the_cache(self):
        cache = {"ROIL_CACHE_DIR": self.path("cache")}
        self.write("effect.lua", PUFF)
        self.run_program("render", "effect.lua", "--frames", "1", "-o", "out.png", *SMALL,
                         environment=cache, before=small_disk)
        self.render(PUFF, environment=cache)


if __name__ == "__main__":
    main()
