"""`roil render --samples`: pictures of a frame that are averaged; and edges that frames smooth."""
import json

from lib.pictures import Exr, Png, packed_pixels
from lib.program import PUFF, SMALL, Case, main

# A card before nothing, of which the alpha tells how much of a pixel it covers. 96 x 54 pixels of
# 0.1 m each, at the card when it is 10 m away.
CARD = """
local fx = effect { name = "card", fps = 10, frames = 10 }
local aperture = param { "aperture", 0, min = 0, max = 4 }
local focus = param { "focus", 0, min = 0, max = 100 }
local light = param { "light", 1, min = 0, max = 1000 }
local way = param { "way", 0, min = -100, max = 100, help = "m/s" }
local turn = param { "turn", 20, min = 0, max = 90 }
fx.camera = camera { eye = {0, -10, 0}, target = {0, 0, 0}, fov = 30.2171, aperture = aperture, focus = focus }
fx.sun = sun { strength = 0 }
fx.sky = sky { zenith = {1, 1, 1}, horizon = {1, 1, 1}, strength = light }
local card = mesh { "card.obj", position = vec(way * time - 2, 0, 0), rotation = vec(0, turn, 0) }
local scene = geometry { card }
local shown = final { shade { from = scene, sky_alpha = 0 }, tonemap = "none" }
fx.output = shown.color
fx.linear = shown.linear
%s
return fx
"""
QUAD = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n"

# A ball of fire that rises through itself, before cards on the ground; `turns` is of the camera.
FIRE = """
local fx = effect { name = "fire", fps = 24, frames = 48 }
local turns = param { "turns", 0, min = -90, max = 90 }
fx.camera = orbit { target = {0, 0, 2}, distance = 12, pitch = 8, fov = 32, yaw = turns * time }
local scene = geometry { mesh { "ground.obj" }, mesh { "card.obj", position = {-3, 0, 1}, rotation = {0, 20, 0} },
                         mesh { "card.obj", position = {3, 0, 1}, rotation = {0, 20, 30} } }
local ball = sphere { position = {0, 0, 2.6}, radius = 2.4, falloff = 2.4 }
local lumps = perlin { frequency = 0.8, octaves = 2, drift = {0, 0, 0.5} }
local smoke = ball * smoothstep(0, 0.15, ball - 0.3 + lumps)
local volume = march { density = smoke * 12, emission = vec(1, 0.3, 0.05) * smoke * 40, from = scene, steps = 24,
                       shadow_steps = 2, resolution = 0.5 }
fx.output = final { over { volume, shade { from = scene }, from = {volume, scene} } }.color
fx.antialias = true
return fx
"""


def difference(a, b):
    return (sum((x - y) ** 2 for x, y in zip(a, b)) / len(a)) ** 0.5


class Samples(Case):
    def setUp(self):
        super().setUp()
        self.write("card.obj", QUAD)

    def alpha(self, *args, effect=CARD % "", frame="1"):
        self.render(effect, "--frames", frame, *args, output="out.exr")
        return Exr(self.read("out.exr")).channels["A"]

    def row(self, *args, **options):
        """Of the alpha, through the card's middle."""
        return self.alpha(*args, **options)[27 * 96:28 * 96]

    def test_an_edge_is_smooth_and_covers_what_it_covers(self):
        self.assertLess(max(min(a, abs(1 - a)) for a in self.alpha()), 1e-3)
        smooth = self.alpha("--samples", "64", "--shutter", "0")
        self.assertAlmostEqual(sum(smooth), 400, delta=1)
        partly = [a for a in smooth if 0.05 < a < 0.95]
        self.assertGreater(len(partly), 50)
        for y in range(54):  # no pixel but those at the edge
            for x in range(96):
                away = max(abs(self.turned(x, y)[i]) for i in range(2)) - 1
                if abs(away) > 0.11:
                    self.assertAlmostEqual(smooth[96 * y + x], away < 0, delta=1e-3)

    @staticmethod
    def turned(x, y):
        """The middle of a pixel in the card's own space."""
        right, up = 0.1 * (x + 0.5 - 48) + 2, 0.1 * (27 - y - 0.5)
        return 0.93969 * right - 0.34202 * up, 0.34202 * right + 0.93969 * up

    def test_more_samples_come_nearer_to_256(self):
        truth = self.alpha("--samples", "256", "--shutter", "0")
        errors = [difference(self.alpha("--samples", str(n), "--shutter", "0"), truth)
                  for n in (1, 4, 16, 64)]
        for worse, better in zip(errors, errors[1:]):
            self.assertLess(better, 0.6 * worse)  # by chance alone it were half

    def test_what_moves_is_blurred_by_its_way(self):
        still = self.row("--set", "turn=0", *("--samples", "32"))
        self.assertAlmostEqual(sum(still), 20, delta=0.1)
        for shutter, pixels in (("0.5", 10), ("1", 20)):  # 20 m/s, 10 frames/s, 0.1 m
            moved = self.row("--set", "turn=0", "--set", "way=20", "--samples", "32", "--shutter", shutter)
            self.assertAlmostEqual(sum(moved), 20, delta=0.1)
            self.assertAlmostEqual(sum(a > 0.02 for a in moved), 20 + pixels, delta=1)
            # It opens at the frame: there it is where it is in a picture of its own.
            self.assertAlmostEqual(min(x for x in range(96) if moved[x] > 0.02), 18, delta=1)
            inner = [a for a in moved if a > 0.02][1:pixels - 1]
            self.assertAlmostEqual(inner[len(inner) // 2], 0.5 * min(20, pixels) / pixels, delta=0.1)

    def test_what_a_simulation_carries_is_blurred_by_its_way(self):
        # A puff in air that moves as a whole, and a particle that flies: 2 m/s, 0.2 m/frame.
        effect = """
local fx = effect { name = "carried", fps = 10, frames = 10 }
fx.camera = camera { eye = {0, -10, 0}, target = {0, 0, 0}, orthographic = 5.4 }
local flies = particles { count = 1, burst = 1, shape = sphere { radius = 0.01 }, velocity = {20, 0, 0}, lifetime = 9 }
local shown = final { splats { flies, size = 0.2, color = {1, 1, 1}, opacity = 1 }, tonemap = "none" }
fx.output = shown.color
fx.linear = shown.linear
return fx
"""
        wide = {shutter: [x for x in range(96) if any(v > 0.01 for v in self.column(effect, shutter, x))]
                for shutter in ("0", "1")}
        self.assertAlmostEqual(len(wide["1"]) - len(wide["0"]), 20, delta=2)

    def column(self, effect, shutter, x):
        if (effect, shutter) not in getattr(self, "drawn", {}):
            self.render(effect, "--frames", "2", "--samples", "32", "--shutter", shutter, output="out.exr")
            self.drawn = {**getattr(self, "drawn", {}), (effect, shutter): Exr(self.read("out.exr")).channels["G"]}
        return self.drawn[effect, shutter][x::96]

    def test_a_lens_blurs_what_is_not_in_focus(self):
        lens = ("--set", "turn=0", "--set", "aperture=1", "--samples", "128", "--shutter", "0")
        sharp = self.row(*lens)  # the target, 10 m away
        self.assertLess(sum(0.02 < a < 0.98 for a in sharp), 5)
        for focus, pixels in ((5, 10), (20, 5)):  # a metre of lens, by how far off 10 m is
            blurred = self.row(*lens, "--set", f"focus={focus}")
            self.assertAlmostEqual(sum(blurred), 20, delta=0.3)
            self.assertAlmostEqual(sum(a > 0.005 for a in blurred), 20 + pixels, delta=2)

    def test_a_reference_has_the_same_lens(self):
        traced = CARD.replace("shade { from = scene, sky_alpha = 0 }",
                              "reference { density = 0 * sphere { radius = 1 }, samples = 64, bounces = 1, sky_alpha = 0 }")
        args = ("--set", "turn=0", "--set", "aperture=2", "--set", "focus=20")
        want = self.row(*args, "--samples", "128", "--shutter", "0")
        got = self.row(*args, effect=traced % "")
        self.assertLess(difference(want, got), 0.06)
        sharp = self.row("--set", "turn=0", effect=traced % "")
        self.assertGreater(difference(want, sharp), 0.1)

    def test_light_is_averaged_before_the_tone_map(self):
        self.render(CARD % "", "--set", "light=100", "--samples", "64", "--shutter", "0")
        bright = Png(self.read("out.png")).channel(1)
        alpha = self.alpha("--samples", "64", "--shutter", "0")
        half = [v for v, a in zip(bright, alpha) if 0.4 < a < 0.6]
        self.assertGreater(len(half), 5)
        self.assertEqual(set(half), {255})

    def test_bloom_that_is_not_of_the_last_picture_is_averaged_too(self):
        bloom = CARD.replace("local shown = final { shade { from = scene, sky_alpha = 0 },",
                             "local solid = shade { from = scene, sky_alpha = 0 }\n"
                             "local shown = final { shade { from = scene, sky_alpha = 0 }, solid, bloom_intensity = 1,")
        self.render(bloom % "", "--samples", "16", "--shutter", "0", output="out.exr")
        both = Exr(self.read("out.exr"))
        for green, a in zip(both.channels["G"], both.channels["A"]):
            if 0.2 < a < 0.8:
                self.assertAlmostEqual(green, 2 * a * max(both.channels["G"]) / 2, delta=0.02)

    def test_two_runs_are_the_same_and_a_recipe_says_how(self):
        self.render(PUFF, "--frames", "2", "--samples", "3", "--shutter", "0.25", output="a.png")
        self.succeeds("repro", "a.png", "-o", "b.png")
        self.assertEqual(packed_pixels(self.read("a.png")), packed_pixels(self.read("b.png")))
        self.assertIn(b'"--samples=3","--shutter=0.25"', self.read("a.png").replace(b'", "', b'","'))

    def test_times_are_those_of_all_pictures(self):
        self.render(PUFF, "--samples", "4", "--stats", self.path("four.json"))
        frame = json.loads(self.read("four.json"))["frames"][0]
        self.assertIn("mean", json.dumps(frame))

    def test_what_makes_no_sense_is_refused(self):
        self.write("effect.lua", PUFF)
        self.fails(2, "1 to 65536", "render", "effect.lua", "--samples", "0", *SMALL)
        self.fails(2, "0 to 1 frames", "render", "effect.lua", "--samples", "2", "--shutter", "1.5", *SMALL)
        self.fails(2, "exclude each other", "render", "effect.lua", "--samples", "2", "--reference", "2", *SMALL)


class Antialias(Case):
    def setUp(self):
        super().setUp()
        self.write("card.obj", QUAD)

    def alpha(self, effect, *args):
        self.render(effect, *args, output="out.exr")
        return Exr(self.read("out.exr")).channels["A"]

    def test_frames_smooth_an_edge(self):
        smooth = CARD % "fx.antialias = true"
        truth = self.alpha(CARD % "", "--samples", "64", "--shutter", "0")
        first = self.alpha(smooth)
        self.assertEqual(first, self.alpha(CARD % ""))  # one picture is not moved
        gathered = self.alpha(smooth, "--frames", "10", "--warmup", "9")
        self.assertLess(difference(gathered, truth), 0.5 * difference(first, truth))
        off = self.alpha(smooth, "--frames", "10", "--warmup", "9", "--set", "effect.antialias=false")
        self.assertEqual(off, first)

    def test_fire_comes_nearer_to_what_is_seen_and_may_move(self):
        for turns, part in (("0", 0.6), ("12", 1.25)):
            def shown(*args, frame=("--frames", "14", "--set", f"turns={turns}")):
                self.render(FIRE, *frame, *args)
                return Png(self.read("out.png")).channel(0)
            truth = shown("--samples", "32", "--shutter", "0")
            rough = shown("--set", "effect.antialias=false")
            self.assertLess(difference(shown("--warmup", "12"), truth), part * difference(rough, truth))

    def test_what_moves_leaves_no_trail(self):
        moving = CARD % "fx.antialias = true"
        args = ("--frames", "10", "--set", "way=3", "--set", "turn=0")
        truth = self.alpha(CARD % "", *args, "--samples", "64", "--shutter", "0")
        gathered = self.alpha(moving, *args, "--warmup", "9")
        self.assertEqual({round(v) for v in truth[20 * 96:34 * 96]}, {0, 1})
        for y in range(20, 34):
            for x in range(3, 93):
                if len(set(truth[96 * y + x - 3:96 * y + x + 4])) == 1:
                    self.assertAlmostEqual(gathered[96 * y + x], truth[96 * y + x], delta=0.02)

    def test_it_takes_true_or_false(self):
        self.write("card.obj", QUAD)
        self.refuses(CARD % "fx.antialias = 8", "takes true or false")
        self.refuses('local fx = effect { name = "bare" }\nfx.antialias = true\nfx.output = geometry {}\nreturn fx\n',
                     "a pass `final` takes")


if __name__ == "__main__":
    main()
