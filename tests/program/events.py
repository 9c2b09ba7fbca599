"""Events of an effect on the command line: the same ones give the same pictures, whichever frames are drawn."""
import json

from lib.pictures import packed_pixels
from lib.program import SMALL, Case, main

BALL = """
local fx = effect { name = "ball", fps = 10, frames = 14 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 20 }
local place = param { "place", {0, 0, 1} }
local bright = param { "bright", 1, min = 0, max = 9 }
local clicks, way = 0, {0, 0}
fx:on_start(function() clicks, way = 0, {0, 0} end)
fx:on_frame(function(t, dt)
  local at = place:get()
  place:set { at[1] + way[1] * dt, at[2] + way[2] * dt, at[3] }
end)
fx:on_click(function(event)
  clicks = clicks + 1
  way = { event.hit.position[1], event.hit.position[2] }
  fx:status("clicks", clicks)
  fx:status("moves", true)
end, "go there")
fx:on_key("b", function() bright:set(4) end, "brighter")
fx.events = { { 0.2, click = {0.7, 0.8} } }
local sparks = particles { count = 64, rate = 60, lifetime = 2, position = place, outward = 1, gravity = 1 }
local volume = march { density = sphere { position = place, radius = 1 } * 3, steps = 8, emission = vec(1, 0.4, 0.1) * bright }
local lit = over { splats { particles = sparks, size = 0.2, color = vec(1, 0.5, 0.2) * bright }, volume }
fx.output = final { lit }.color
return fx
"""


class Events(Case):
    def setUp(self):
        super().setUp()
        self.write("ball.lua", BALL)

    def render(self, folder, *more):
        self.succeeds("render", "ball.lua", *SMALL, "-o", folder + "/%d.png", *more)
        return packed_pixels(self.read(folder + "/14.png"))

    def test_what_the_script_says_of_itself_is_printed(self):
        printed = self.succeeds("render", "ball.lua", *SMALL, "-o", "o.png", "--frames", "14")
        self.assertIn("effect: clicks 1, moves yes\n", printed)

    def test_frames_left_out_change_nothing(self):
        whole = self.render("whole")
        self.assertEqual(whole, self.render("again"))
        self.assertEqual(whole, self.render("last", "--frames", "14"))
        self.assertEqual(whole, self.render("back", "--frames", "14,3,14"))
        self.assertNotEqual(whole, self.render("none", "--frames", "14", "--set", "effect.events="))

    def test_events_of_the_command_line(self):
        own = self.render("own", "--frames", "14")
        told = ["--frames", "14", "--event", "0.5 key b", "--event", "0.2 click 0.7 0.8"]
        first = self.render("first", *told, "--stats", "stats.json")
        self.assertNotEqual(own, first)
        readouts = json.loads(self.read("stats.json"))["readouts"]
        self.assertEqual(readouts["effect.clicks"], 1)
        self.succeeds("render", "--from", "first/14.png", "-o", "from.png")
        self.assertEqual(first, packed_pixels(self.read("from.png")))
        self.fails(1, "the effect handles no key x; it handles: click, key b", "render", "ball.lua", "--event", "1 key x")
        self.fails(1, "event '1 tap'; accepted: SECONDS click X Y", "render", "ball.lua", "--event", "1 tap")
        self.fails(1, "key 'space'; accepted: a letter as f, a digit, enter", "render", "ball.lua", "--event", "1 key space")
        info = self.succeeds("info", "params", "ball.lua")
        self.assertIn("events = 0.2 click 0.7 0.8", info)

    def test_a_restored_run_is_told_of_what_was_before(self):
        whole = self.render("whole", "--event", "0.2 click 0.7 0.8", "--event", "1.1 key b")
        self.render_until(6)
        self.assertEqual(whole, self.render("then", "--restore", "ball.state", "--event", "0.2 click 0.7 0.8",
                                            "--event", "1.1 key b"))

    def render_until(self, frame):
        self.succeeds("render", "ball.lua", *SMALL, "--frames", "1-%d" % frame, "-o", "first/%d.png",
                      "--event", "0.2 click 0.7 0.8", "--event", "1.1 key b", "--checkpoint", "ball.state")


if __name__ == "__main__":
    main()
