"""What the script of an effect hears in the window: clicks that are no drags, and its own keys."""
import os
import re
import subprocess

from lib.window import PATIENCE, PROGRAM, Case, difference, main, require_tools

# The ball goes where the ground was clicked, and becomes bright by a key that the window has too.
BALL = """
local fx = effect { name = "ball", fps = 10, frames = 40 }
fx.camera = orbit { target = {0, 0, 1}, distance = 8, pitch = 30 }
local place = param { "place", {0, 0, 1} }
local bright = param { "bright", 1, min = 0, max = 9 }
local clicks = 0
fx:on_start(function() clicks = 0; fx:status("clicks", 0) end)
fx:on_click(function(event)
  clicks = clicks + 1
  place:set { event.hit.position[1], event.hit.position[2], 1 }
  fx:status("clicks", clicks)
end, "the ball goes there")
fx:on_key("f", function() bright:set(5) end, "brighter")
local volume = march { density = sphere { position = place, radius = 1 } * 3, steps = 8, emission = vec(1, 0.4, 0.1) * bright }
fx.output = final { volume.color }.color
return fx
"""
EVENTS = r"live: set effect\.events = (.*)"


class Events(Case):
    def click(self, live, x, y):
        left, top, right, bottom = live.widget("view")
        live.click(left + (right - left) * x, top + (bottom - top) * y)
        return live.expect(EVENTS).group(1)

    def picture(self, live):
        left, top, right, bottom = live.widget("view")
        return live.screenshot().crop(left, top + (bottom - top) / 3, right, bottom) # without what is said above

    def test_clicks_and_keys(self):
        live = self.live(effect=BALL)
        live.expect("live: shown")
        before = self.picture(live)
        said = self.click(live, 0.75, 0.6)
        self.assertRegex(said, r"^0 click( -?[\d.e-]+){6}$")
        live.expect(r"live: drew frame 1\b")
        live.expect("live: shown")
        moved = self.picture(live)
        self.assertGreater(difference(before, moved), 40) # the ball in its new place
        live.keys("f")
        self.assertRegex(live.expect(EVENTS).group(1), r"^0 click( -?[\d.e-]+){6}; 0 key f( -?[\d.e-]+){6}$")
        live.wait_until(lambda: difference(moved, self.picture(live)) > 40, "a brighter ball")

        # Both are undone, one by one, and done again.
        for wanted, what in ((moved, "the ball before the key"), (before, "the ball before the click")):
            live.keys("ctrl+z")
            live.expect(r"live: undid .*events")
            live.wait_until(lambda: difference(wanted, self.picture(live)) < 6, what)
        for _ in range(2):
            live.keys("ctrl+y")
            live.expect(r"live: redid .*events")
        live.wait_until(lambda: difference(moved, self.picture(live)) > 40, "a brighter ball again")

        # A drag turns the camera and is no click; Alt has the window's own key.
        left, top, right, bottom = live.widget("view")
        mark = live.mark()
        live.drag(((left + right) / 2, (top + bottom) / 2), ((left + right) / 2 + 90, (top + bottom) / 2))
        live.expect(r"live: set camera\.eye", mark)
        live.keys("alt+f")
        live.expect(r"live: set camera\.target", live.read_to)
        self.assertFalse([line for line in live.log[mark:] if re.search(EVENTS, line)])

        # Time goes on, and back: what was done is done again. The recipe of a picture knows it, too.
        live.keys("End")
        live.expect(r"live: drew frame 40\b")
        last = self.click(live, 0.3, 0.7)
        self.assertRegex(last, r"; 3\.9 click( -?[\d.e-]+){6}$")
        live.keys("Home")
        live.expect(r"live: drew frame 1\b", live.read_to)
        live.keys("End", "F12")
        shot = live.expect(r"live: wrote (\S+\.png)").group(1)
        live.keys("F1")
        live.widget("help")
        live.quit()
        subprocess.run([PROGRAM, "render", "--from", shot, "-o", "again.png"], cwd=self.folder,
                       env=self.environment, check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)
        compare = os.path.join(os.path.dirname(PROGRAM), "golden_compare")
        same = subprocess.run([compare, shot, "again.png", "difference.png"], cwd=self.folder,
                              check=False, stdout=subprocess.PIPE, text=True, timeout=PATIENCE)
        self.assertEqual(same.returncode, 0, same.stdout)

    def test_a_reload_keeps_what_was_done(self):
        live = self.live(effect=BALL)
        live.expect("live: shown")
        self.click(live, 0.75, 0.6)
        live.expect(r"live: drew frame 1\b")
        live.expect("live: shown")
        moved = self.picture(live)
        self.write("puff.lua", BALL.replace("{1, 0.4, 0.1}", "{1, 0.4, 0.1} ").replace("the ball goes there", "here"))
        live.expect("live: took over")
        live.wait_until(lambda: difference(moved, self.picture(live)) < 6, "the ball in the same place")
        live.quit()


require_tools()
main()
