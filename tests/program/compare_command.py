"""`roil compare`: figures of two pictures, limits, and the picture of their difference."""
import json
import os
import re

from lib.pictures import Exr, Png, exr_header, write_png
from lib.program import PUFF, SMALL, Case, main


def encode(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


class CompareCommand(Case):
    def setUp(self):
        super().setUp()
        write_png(self.path("a.png"), 32, 24, lambda x, y: (x * 4, y * 5, 100))
        write_png(self.path("b.png"), 32, 24, lambda x, y: (x * 4 + 10 * (x > 15), y * 5, 100))
        write_png(self.path("c.png"), 32, 24, lambda x, y: (x * 4 + 90 * (x > 15), y * 5, 100))
        write_png(self.path("small.png"), 31, 24, lambda x, y: (0, 0, 0))

    def figures(self, *args):
        told = self.succeeds("compare", *args)
        return [float(re.search(rf"^{name} +(\S+)", told, re.M).group(1))
                for name in ("PSNR", "SSIM", "FLIP")]

    def test_equal_pictures(self):
        told = self.succeeds("compare", "a.png", "a.png", "--max-flip", "0", "--min-psnr", "99",
                             "--json", "out.json")
        self.assertRegex(told, r"PSNR +inf dB\nSSIM +1\.00000\nFLIP +0\.00000\n")
        saved = json.loads(self.read("out.json"))
        self.assertIsNone(saved["psnr"])
        self.assertEqual((saved["ssim"], saved["flip"]), (1, 0))

    def test_more_change_is_more_difference(self):
        little, much = self.figures("a.png", "b.png"), self.figures("a.png", "c.png")
        self.assertGreater(little[0], much[0])
        self.assertGreater(little[1], much[1])
        self.assertLess(little[2], much[2])
        # A sixth of all numbers is off by 10 of 255.
        self.assertAlmostEqual(little[0], 35.913, places=2)

    def test_distance_of_the_observer_counts(self):
        self.assertNotEqual(self.figures("a.png", "c.png"),
                            self.figures("a.png", "c.png", "--ppd", "20"))

    def test_difference_picture_is_dark_where_nothing_differs(self):
        self.succeeds("compare", "a.png", "c.png", "-o", "new/out.png")
        picture = Png(self.read("new/out.png"))
        self.assertEqual((picture.width, picture.height), (32, 24))
        self.assertEqual(picture.rows[12][:3], (0, 0, 4))
        self.assertGreater(sum(picture.rows[12][-3:]), 150)

    def test_both_and_their_difference_beside_each_other(self):
        self.succeeds("compare", "a.png", "c.png", "-o", "out.png", "--beside", "beside.png")
        beside = Png(self.read("beside.png"))
        self.assertEqual((beside.width, beside.height), (96, 24))
        parts = [Png(self.read(name)) for name in ("a.png", "c.png", "out.png")]
        for y in (0, 12, 23):
            row = [v for part in parts for x in range(32)
                   for v in part.rows[y][x * part.channels:][:3]]
            self.assertEqual(list(beside.rows[y]), row)

    def test_limits_end_with_status_3(self):
        self.succeeds("compare", "a.png", "b.png", "--max-flip", "0.5", "--min-psnr", "30")
        self.fails(3, ["b.png differs from a.png", "FLIP", "at most 0.001"], "compare", "a.png",
                   "b.png", "--max-flip", "0.001")
        self.fails(3, ["FLIP", "PSNR 35.9", "at least 40"], "compare", "a.png", "b.png",
                   "--max-flip", "0.001", "--min-psnr", "40")

    def test_exr_is_exposed_and_encoded(self):
        self.write("puff.lua", PUFF)
        self.succeeds("render", "puff.lua", "--frames", "5", "-o", "puff.exr", *SMALL)
        picture = Exr(self.read("puff.exr"))
        for stops in (0, 1):
            def shown(x, y):
                linear = (picture.channels[c][y * picture.width + x] * 2**stops for c in "RGB")
                return [round(255 * encode(min(max(v, 0), 1))) for v in linear]
            write_png(self.path("shown.png"), picture.width, picture.height, shown)
            psnr, ssim, flip = self.figures("puff.exr", "shown.png", "--exposure", str(stops))
            self.assertGreater(psnr, 55)
            self.assertGreater(ssim, 0.99)
            self.assertLess(flip, 0.04)  # 8 bits alone are 0.025: small errors weigh much
        self.assertLess(self.figures("puff.exr", "shown.png")[0], 40)

    def test_pictures_that_cannot_be_compared(self):
        self.write("text.png", "no picture")
        self.write("text.exr", "no picture")
        self.fails(1, ["a.png is 32x24", "small.png is 31x24"], "compare", "a.png", "small.png")
        self.fails(1, "text.png", "compare", "a.png", "text.png")
        self.fails(1, "text.exr", "compare", "text.exr", "a.png")
        self.fails(1, "absent.png", "compare", "a.png", "absent.png")
        self.fails(1, "accepted: .png, .exr", "compare", "a.png", "b.jpg")
        self.fails(1, "accepted: .png", "compare", "a.png", "b.png", "-o", "out.jpg")
        self.assertFalse(os.path.exists(self.path("out.jpg")))

    def test_a_picture_that_would_fill_the_memory_is_refused_by_its_header(self):
        self.write("huge.exr", exr_header(16384, 16384, "RGB"))
        self.fails(1, ["huge.exr: a picture of 16384x16384 with 12 bytes a pixel takes 3072 MiB", "up to 1024 MiB"],
                   "compare", "huge.exr", "a.png")
        self.write("wide.exr", exr_header(16385, 1, "RGB"))
        self.fails(1, "wide.exr", "compare", "wide.exr", "a.png")

    def test_pictures_are_decoded_by_another_program(self):
        """Which can be named, and without which none is."""
        self.fails(1, ["a.png", "/nowhere/roil-reader"], "compare", "a.png", "a.png",
                   environment={"ROIL_READER": "/nowhere/roil-reader"})

    def test_mistakes(self):
        self.fails(2, "two pictures", "compare", "a.png")
        self.fails(2, "two pictures", "compare", "a.png", "b.png", "c.png")
        self.fails(2, "--max-flip is 0 to 1", "compare", "a.png", "b.png", "--max-flip", "2")
        self.fails(2, "--min-psnr", "compare", "a.png", "b.png", "--min-psnr", "nan")
        self.fails(2, "--flop", "compare", "a.png", "b.png", "--flop")
        for ppd in ("0.5", "nan", "-3", "inf"):
            self.fails(1, "1 to 1000", "compare", "a.png", "b.png", "--ppd", ppd)
        for exposure in ("nan", "65", "-65"):
            self.fails(1, "-64 to 64", "compare", "a.png", "b.png", "--exposure", exposure)
        self.assertIn("sRGB-encoded", self.succeeds("compare", "--help"))


if __name__ == "__main__":
    main()
