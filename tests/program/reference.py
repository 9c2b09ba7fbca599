"""`roil render --reference`: paths of light in place of every march."""
import json

from lib.pictures import Exr, packed_pixels
from lib.program import PUFF, SMALL, VOLUME, Case, main

BALL = VOLUME % "sphere { position = {1, 1, 1}, radius = 1, falloff = 0.5 } * 4"


class Reference(Case):
    def test_frame_is_traced_until_it_has_its_samples(self):
        self.render(PUFF, "--reference", "3", "--stats", self.path("stats.json"), output="out.exr")
        stats = json.loads(self.read("stats.json"))
        self.assertEqual(stats["frames"][0]["samples"], 3)
        self.assertGreater(stats["frames"][0]["counters"]["march.samples"], 1000)
        self.assertEqual(min(Exr(self.read("out.exr")).channels["A"]), 1)  # no hole for the ground
        self.assertNotIn("samples", self.stats_of_a_march())

    def stats_of_a_march(self):
        self.render(PUFF, "--stats", self.path("stats.json"))
        return json.loads(self.read("stats.json"))["frames"][0]

    def test_more_samples_are_less_noise(self):
        noise = []
        for samples in ("2", "32"):
            self.render(BALL, "--reference", samples, "--set", "march.filter=none", output="out.exr")
            picture = Exr(self.read("out.exr"))
            row = [picture.channels["G"][27 * 96 + x] for x in range(40, 56)]
            noise.append(sum(abs(a - b) for a, b in zip(row, row[1:])))
        self.assertLess(noise[1], 0.5 * noise[0])

    def test_two_runs_are_the_same_bit_for_bit(self):
        self.render(PUFF, "--reference", "2", "--frames", "1,2", output="a%d.png")
        self.render(PUFF, "--reference", "2", "--frames", "2", output="b%d.png")
        self.assertEqual(packed_pixels(self.read("a2.png")), packed_pixels(self.read("b2.png")))

    def test_what_is_said_to_the_march_is_no_error(self):
        self.render(PUFF, "--reference", "1", "--set", "march.steps=9", "--set", "march.resolution=0.5",
                    "--set", "march.mode=paper", "--set", "march.bounces=2")
        self.fails(1, "unknown uniform 'stepz'", "render", "effect.lua", "--reference", "1", "--frames", "1",
                   "--set", "march.stepz=9", *SMALL)
        self.fails(1, "stepz", "render", self.write("wrong.lua", BALL.replace("steps", "stepz")),
                   "--reference", "1", "--frames", "1", *SMALL)

    def test_an_effect_may_have_one_of_its_own(self):
        own = BALL.replace("march {", "reference {").replace("steps = 8, shadow_steps = 2", "samples = 2")
        self.render(own)
        self.render(own, "--reference", "4", "--stats", self.path("stats.json"))
        self.assertEqual(json.loads(self.read("stats.json"))["frames"][0]["samples"], 4)

    def test_effect_without_a_march_is_refused(self):
        self.write("bare.lua", 'local fx = effect { name = "bare" }\nfx.output = geometry {}\n')
        self.fails(1, "passes `march`, and the effect has none", "render", "bare.lua", "--reference", "1", *SMALL)
        self.write("unseen.lua", VOLUME.replace("final { volume.color }", "final { geometry {} }") %
                   "sphere { radius = 1 }")
        self.fails(1, "does not show", "render", "unseen.lua", "--reference", "1", "--frames", "1", *SMALL)

    def test_number_of_samples_is_checked(self):
        self.write("effect.lua", PUFF)
        for wrong in ("0", "-1", "65537", "many", "1.5", ""):
            self.fails(2, "1 to 65536", "render", "effect.lua", "--reference", wrong)


if __name__ == "__main__":
    main()
