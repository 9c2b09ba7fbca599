"""A VDB sequence as one raw file, and the same picture from it."""
import glob
import os
import re
import shutil

from lib.pictures import Png
from lib.program import SMALL, SOURCE, Case, main

FILES = os.path.join(SOURCE, "effects", "data", "explosion-32", "003*.vdb")
EFFECT = """
local fx = effect { name = "x", frames = 10 }
fx.camera = orbit { target = {4, 4, 2.5}, distance = 14 }
local burst = %s
fx.output = final { march { density = burst.density * 8, steps = 48 } }.color
return fx
"""


class Export(Case):
    def picture(self, source):
        self.write("effect.lua", EFFECT % source)
        self.succeeds("render", "effect.lua", "--frames", "5", "-o", "out.png", *SMALL)
        with open(self.path("out.png"), "rb") as f:
            return Png(f.read())

    def test_raw_plays_back_as_the_sequence_does(self):
        os.makedirs(self.path("data"))
        for file in glob.glob(FILES):
            shutil.copy(file, self.path("data"))
        wanted = self.picture('vdb { "data/003*.vdb" }')
        for kind, tolerance in (("u8", 4), ("u16", 1), ("f16", 1), ("f32", 1)):
            with self.subTest(kind):
                told = self.succeeds("export", "raw", FILES, "-o", "out.raw", "--type", kind)
                got = self.picture(re.search(r"raw \{.*\}", told).group())
                worst = max(abs(a - b) for c in range(3)
                            for a, b in zip(wanted.channel(c), got.channel(c)))
                self.assertLessEqual(worst, tolerance)

    def test_what_is_printed_can_be_loaded_from_beside_the_effect(self):
        told = self.succeeds("export", "raw", FILES, "-o", self.path("out.raw"))
        self.write("effect.lua", EFFECT % re.search(r"raw \{.*\}", told).group())
        self.succeeds("check", "effect.lua")

    def test_gaps_and_what_is_up_are_kept(self):
        os.makedirs(self.path("plain"))
        for number in "0136":
            shutil.copy(FILES.replace("*", number), self.path("plain"))
        self.write("effect.lua", EFFECT % 'vdb { "plain/*.vdb" }')
        self.succeeds("export", "vdb", "effect.lua", "--source", "burst", "-o", "made/%d.vdb")
        for number in "1247":
            data = self.read(f"made/{number}.vdb")
            begin = data.index(b"roil ")
            length = int.from_bytes(data[begin - 4:begin], "little")
            self.write(f"data/{number}.vdb", data[:begin] + b"Houdini".ljust(length) + data[begin + length:])
        wanted = self.picture('vdb { "data/*.vdb", offset = {4, 4, 2} }')
        told = self.succeeds("export", "raw", self.path("data/*.vdb"), "-o", "out.raw", "--type", "f32")
        self.assertIn("7 frames of", told)
        self.assertIn("y_up = true", told)
        source = re.search(r"raw \{.*\}", told).group()
        got = self.picture(source[:-1] + ", offset = {4, 4, 2} }")
        self.assertLessEqual(max(abs(a - b) for c in range(3) for a, b in zip(wanted.channel(c), got.channel(c))), 1)
        self.assertGreater(max(wanted.channel(0)), 0)
        lying = self.picture('vdb { "data/*.vdb", offset = {4, 4, 2}, y_up = false }')
        self.assertNotEqual(wanted.channel(0), lying.channel(0))

    def test_mistakes(self):
        self.fails(2, "which format?", "export")
        self.fails(2, "-o is missing", "export", "raw", FILES)
        self.fails(1, "no file has a grid 'fire'", "export", "raw", FILES, "-o", "a.raw", "--grid", "fire")
        self.fails(1, "accepted: u8, u16, f16, f32", "export", "raw", FILES, "-o", "a.raw", "--type", "u4")
        self.fails(1, "cannot be written", "export", "raw", FILES, "-o", "/proc/a.raw")
        self.assertFalse(os.path.exists(self.path("a.raw")))


if __name__ == "__main__":
    main()
