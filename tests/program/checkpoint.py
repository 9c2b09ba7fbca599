"""A simulation that is kept in a file and goes on from it, on the command line."""
import os

from lib.program import SMALL, Case, main

AIR = """
local fx = effect { name = "air", fps = 60, frames = 5 }
fx.camera = orbit { target = {0, 0, 0.8}, distance = 4 }
local air = lbm { size = {16, 16, 16}, voxel_size = %s, speed = 2, buoyancy_heat = 6, boundary = "periodic",
  collision = "bgk", viscosity = 0.01, smagorinsky = 0 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1, temperature = 2 }
fx.output = final { march { density = air.density * 30, steps = 8 } }.color
return fx
"""


class Checkpoint(Case):
    def test_it_goes_on_with_the_frame_after(self):
        self.write("air.lua", AIR % 0.1)
        render = ["render", "air.lua", *SMALL]
        self.succeeds(*render, "-o", "whole/%d.png", "--checkpoint", "end.state")
        told = self.succeeds(*render, "--frames", "1-3", "-o", "first/%d.png", "--checkpoint", "middle.state")
        self.assertIn("wrote middle.state", told)
        self.succeeds(*render, "--restore", "middle.state", "-o", "then/%d.png", "--checkpoint", "again.state")
        self.assertEqual(sorted(os.listdir(self.path("then"))), ["4.png", "5.png"])
        for frame in "4.png", "5.png":
            self.assertEqual(self.read("then/" + frame), self.read("whole/" + frame))
        self.assertEqual(self.read("again.state"), self.read("end.state"))

        self.fails(1, "is of frame 5, the last", *render, "--restore", "end.state")
        self.fails(1, "is of frame 3; frames after it are accepted, not 2", *render, "--restore", "middle.state",
                   "--frames", "2", "-o", "a.png")
        self.fails(2, "exclude each other", *render, "--restore", "middle.state", "--warmup", "2")
        self.write("air.lua", AIR % 0.2)
        self.fails(1, "made with voxel_size = 0.1, the effect has voxel_size = 0.2", *render, "--restore", "middle.state")


if __name__ == "__main__":
    main()
