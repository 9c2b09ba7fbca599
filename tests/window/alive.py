"""The window while the device works: it is drawn, it answers, it says what is at work, and what was
drawn once is shown again at once."""
import json
import os
import struct
import subprocess

from lib.window import PATIENCE, PROGRAM, Case, difference, main, require_tools

VIEW, SWITCH = "view", "every frame"

# From frame 2 on a picture takes seconds: a sum that is not used, but no compiler knows that.
SLOW = """// Takes as long as it is told, and passes on the picture.
uniform float turns; //= 1 [0, 1000000] : of a loop
uniform sampler2D source; //= input : the picture
uniform writeonly image2D color; //= output rgba16f : the same picture
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    float sum = 0.0;
    for (float i = 0.0; i < turns; i += 1.0) sum += sin(sum + i);
    imageStore(color, at, texelFetch(source, at, 0) + min(sum, 0.0) * 1e-9);
}
"""
EFFECT = """
local fx = effect { name = "slow", fps = 24, frames = 12 }
local size = param { "size", 1, min = 0.1, max = 2 }
local turns = function(t) return t > 0 and %d or 1 end
local ball = march { density = sphere { radius = function(t) return 0.6 + t end } * size, steps = 8, shadow_steps = 1 }
fx.camera = orbit { distance = 5 }
fx.output = final { shader { "slow.comp", source = ball, turns = turns } }.color
return fx
"""


class Alive(Case):
    def slow(self, turns, *args):
        self.write("slow.comp", SLOW)
        return self.live("--preview", "quarter", *args, effect=EFFECT % turns)

    def test_hands_are_answered_while_a_frame_is_at_work(self):
        live = self.slow(16000, "--stats", "stats.json")
        live.widget(SWITCH)
        mark = live.mark()
        live.keys("Right")
        live.wait_until(lambda: "work" in live.widgets(), "the sign that a frame is at work")
        for _ in range(2):
            before = live.screenshot().crop(*live.widgets()[SWITCH])
            live.click_on(SWITCH)
            live.wait_until(lambda: difference(before, live.screenshot().crop(*live.widgets()[SWITCH])) > 20,
                            "the answer of the switch")
        self.assertNotIn("live: drew frame 2", live.log[mark:], "the frame was too quick to tell")
        live.expect("live: drew frame 2", mark)
        live.wait_until(lambda: "work" not in live.widgets(), "the end of the sign")
        live.quit()
        with open(self.path("stats.json"), encoding="utf-8") as f:
            stats = json.load(f)
        self.assertGreater(stats["busy"]["seconds"], 1)
        self.assertGreater(stats["busy"]["pictures_a_second"], 5)
        self.assertLess(stats["answers"]["p95_ms"], 1000 * stats["busy"]["seconds"] / 2)

    def test_a_frame_that_takes_as_long_as_always_is_not_given_up(self):
        live = self.slow(8000)
        for frame in (2, 3):
            live.keys("Right")
            live.wait_until(lambda: "work" in live.widgets(), "the sign that a frame is at work")
            if frame == 3:
                live.keys("Escape")
            live.expect(f"live: drew frame {frame}")
        live.quit()

    def test_a_window_is_closed_at_once(self):
        live = self.slow(200000, "--stats", self.path("deep/stats.json"))
        live.keys("Right")
        live.wait_until(lambda: "work" in live.widgets(), "the sign that a frame is at work")
        live.quit()
        with open(self.path("deep/stats.json"), encoding="utf-8") as f:  # though the device was given up
            self.assertGreater(json.load(f)["pictures"], 0)


class Film(Case):
    def picture(self, live):
        return live.screenshot().crop(*live.widget(VIEW))

    def test_what_was_drawn_is_shown_again(self):
        self.write("slow.comp", SLOW)
        live = self.live(effect=EFFECT % 1)
        drawn = {}
        for frame in (2, 3, 4):
            live.keys("Right")
            live.expect(f"live: drew frame {frame}")
            live.expect("live: shown")
            drawn[frame] = self.picture(live)
        self.assertGreater(difference(drawn[2], drawn[4]), 8)
        mark = live.mark()
        for key, frame in (("Left", 3), ("Left", 2), ("Right", 3), ("Right", 4)):
            live.keys(key)
            if frame != 4:
                live.expect(f"live: shows frame {frame}")
            live.wait_until(lambda: difference(drawn[frame], self.picture(live)) == 0, "the same picture")
        self.assertNotIn("live: drew", "\n".join(live.log[mark:]))
        left, top, right, bottom = live.widget("size")
        middle = (left + right) / 2
        live.drag((middle, (top + bottom) / 2), (middle + 30, (top + bottom) / 2))  # nothing that was drawn holds
        live.expect("live: set size")
        live.expect("live: drew frame 4")
        live.keys("Left")
        live.expect("live: drew frame 3")
        live.quit()

    def test_it_plays_in_time_once_it_was_drawn(self):
        self.write("slow.comp", SLOW)
        live = self.live(effect=EFFECT % 300)
        live.click_on(SWITCH)
        live.keys("space")
        for frame in (12, 1, 12):
            live.expect(rf"live: (drew|shows) frame {frame}\b")
        mark = live.mark()
        for frame in (1, 12, 1):
            live.expect(rf"live: shows frame {frame}\b", mark)
            mark = live.mark()
        live.keys("space")
        live.quit()

# Smoke that rises as fast as it is told.
LIFT = """
local fx = effect { name = "lift", fps = 24, frames = 240 }
local lift = param { "lift", 0.4, min = 0, max = 4, unit = "m/s" }
local air = slices { count = 1, size = {32, 32}, height = 2, variation = 0 }
air:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density = 1, velocity = {0, lift} }
fx.camera = orbit { target = {0, 0, 1}, distance = 5, pitch = 10 }
fx.output = final { march { density = air.density * 4, steps = 4, shadow_steps = 1 } }.color
return fx
"""


class Simulations(Case):
    def picture(self, live):
        return live.screenshot().crop(*live.widget(VIEW))

    def looks_like(self, live, wanted, sides=((0, 1),)):
        def same():
            now = self.picture(live)
            return all(difference(wanted.crop(a * wanted.width, 60, b * wanted.width, wanted.height - 60),
                                  now.crop(a * now.width, 60, b * now.width, now.height - 60)) == 0 for a, b in sides)
        live.wait_until(same, "the picture that was")

    @staticmethod
    def on_timeline(live, *frames, of=240):
        left, top, right, bottom = live.widget("timeline")
        return [(left + 8 + (frame - 1) / (of - 1) * (right - left - 16), (top + bottom) / 2 + 6) for frame in frames]

    def settled(self, live):
        live.expect("live: shown")
        live.wait_until(lambda: "work" not in live.widgets(), "the end of the work")
        last = [None]

        def stays():
            now = self.picture(live)
            same, last[0] = last[0] is not None and difference(last[0], now) == 0, now
            return now if same else None
        return live.wait_until(stays, "a picture that stays")

    def go_on(self, live, frames):
        for frame in frames:
            mark = live.mark()
            live.keys("Right")
            live.expect(rf"live: (drew|shows) frame {frame}$", mark)
        return self.settled(live)

    def test_a_branch_keeps_its_settings_and_is_compared(self):
        live = self.live("--frame", "20", effect=LIFT)
        live.keys("b")
        live.expect("live: branch B")
        left, top, right, bottom = live.widget("lift")
        middle = (top + bottom) / 2
        live.drag((left + 20, middle), (right - 20, middle))
        live.expect("live: set lift")
        first = self.go_on(live, [21])
        mark = live.mark()
        live.keys("Home")
        live.expect(r"live: drew frame 1\b", mark)
        live.drag((right - 20, middle), (left + 20, middle))  # and back: pictures and snapshots are forgotten
        live.drag((left + 20, middle), (right - 20, middle))
        mark = live.mark()
        live.drag(*self.on_timeline(live, 1, 21))
        live.expect(r"live: drew frame 21\b", mark)
        self.looks_like(live, first)  # from where B began
        fast = self.go_on(live, range(22, 27))
        live.keys("x")
        live.expect("live: branch A")
        live.expect("live: drew frame 26$")  # not one that is early, of which others of this frame follow
        slow = self.settled(live)
        self.assertGreater(difference(slow, fast), 30)
        mark = live.mark()
        live.keys("c")
        line = live.widget("split")
        self.looks_like(live, slow, ((0, 0.45),))
        self.looks_like(live, fast, ((0.55, 1),))
        x, y = (line[0] + line[2]) / 2, (line[1] + line[3]) / 2
        live.drag((x, y), (x - (live.widget(VIEW)[2] * 0.2), y))
        self.looks_like(live, slow, ((0, 0.25),))
        self.looks_like(live, fast, ((0.35, 1),))
        live.keys("c", "x")
        live.expect("live: branch B")
        self.looks_like(live, fast)
        live.keys("x")
        live.expect("live: branch A")
        self.looks_like(live, slow)
        self.assertNotIn("live: drew", "\n".join(live.log[mark:]), "both were there")
        live.quit()

    def test_a_branch_goes_on_from_its_state(self):
        live = self.live("--frame", "20", effect=LIFT)
        live.keys("b")
        live.expect("live: branch B")
        same = self.go_on(live, range(21, 25))  # nothing was set: it goes on as A does
        live.keys("x")
        live.expect("live: branch A")
        live.expect("live: drew frame 24")
        self.looks_like(live, same)
        live.quit()


class Out(Case):
    def ask(self, live, **fields):
        for name, text in fields.items():
            live.click_on("render/" + name)
            live.keys("End", *["BackSpace"] * 24)
            live.type(text)
            live.keys("Return")
        live.click_on("render add")

    def test_renderings_run_beside_the_window(self):
        live = self.live("--set", "thickness=9")
        live.keys("ctrl+r")
        self.ask(live, frames="2-3", size="64x48", files="made/puff")
        live.expect("live: asked for made/puff-%04d.png")
        live.expect("live: rendering of made/puff-%04d.png begins")
        live.click_on(SWITCH)  # the window goes on meanwhile
        live.expect("live: rendering of made/puff-%04d.png done")
        subprocess.run([PROGRAM, "render", "puff.lua", "--set", "thickness=9", "--frames", "2-3", "--size", "64x48", "-o",
                        "other/puff-%04d.png"], cwd=self.folder, env=self.environment, check=True, timeout=PATIENCE,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for number in (2, 3):
            compare = os.path.join(os.path.dirname(PROGRAM), "golden_compare")
            same = subprocess.run([compare, f"made/puff-{number:04}.png", f"other/puff-{number:04}.png", "difference.png"],
                                  cwd=self.folder, check=False, stdout=subprocess.PIPE, text=True, timeout=PATIENCE)
            self.assertEqual(same.returncode, 0, same.stdout)
        live.quit()

    def test_a_sheet_is_made_beside_the_window(self):
        live = self.live("--set", "thickness=9")
        live.keys("ctrl+r")
        live.click_on("render/format")
        live.click_on("render/sheet of a flipbook")
        self.ask(live, **{"cells": "2x2", "cell size": "32", "maps": "color,normal", "files": "made/puff"})
        live.expect("live: asked for made/puff.png")
        live.expect("live: rendering of made/puff.png done")
        subprocess.run([PROGRAM, "export", "sheet", "puff.lua", "--set", "thickness=9", "--grid", "2x2", "--cell", "32", "--maps",
                        "color,normal", "-o", "other/puff.png"], cwd=self.folder, env=self.environment, check=True,
                       timeout=PATIENCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for name in ("puff.png", "puff-normal.png"):
            with open(self.path("made/" + name), "rb") as made, open(self.path("other/" + name), "rb") as other:
                self.assertEqual(made.read(), other.read(), name)
        live.quit()

    def test_what_cannot_be_rendered_says_why_and_what_runs_can_be_stopped(self):
        live = self.live()
        live.keys("ctrl+r")
        self.ask(live, size="wide")
        live.expect("live: rendering of .* failed: .*wide")
        live.click_on("job 0/remove")
        live.wait_until(lambda: "job 0/remove" not in live.widgets(), "an empty queue")
        self.ask(live, frames="1-48", size="1920x1080")
        live.expect("live: rendering of .* begins")
        live.click_on("job 0/stop")
        live.expect("live: rendering of .* stopped")
        live.quit()

    def test_a_shot_is_as_large_as_the_window(self):
        live = self.live("--preview", "quarter")
        live.keys("Right")
        live.expect("live: drew frame 2")
        live.keys("F12")
        shot = live.expect(r"live: wrote (\S+\.png)").group(1)
        left, top, right, bottom = live.widget(VIEW)
        with open(self.path(shot), "rb") as f:
            size = struct.unpack(">2I", f.read(24)[16:])
        self.assertEqual(size, (round(right - left), round(bottom - top)))
        live.keys("Left")
        live.expect("live: shows frame 1")  # what was kept holds
        live.quit()


if __name__ == "__main__":
    require_tools()
    main()
