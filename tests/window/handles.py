"""What stands in space is seen over the picture and dragged in it."""
import os

from lib.window import Case, difference, main, require_tools

VIEW = "view"
STAGE = """
local fx = effect { name = "stage", fps = 24, frames = 49 }
local place = param { "place", {1.6, 0, 1}, min = -4, max = 4, unit = "m", help = "of the second ball" }
local way = curve { {0, {-2, 0, 2}}, {2, {2, 0, 2}}, shape = "linear" }
fx.camera = orbit { target = {0, 0, 1}, distance = 8, pitch = 0 }
fx.sun = sun { azimuth = 300, elevation = 40 }
fx.lights = { point_light { name = "lamp", position = {0, -1, 2.4}, power = 60 }, point_light { position = way, power = 9 } }
local ball = sphere { position = {0, 0, 1}, radius = 0.6, falloff = 0.3 }
local other = sphere { position = place, radius = 0.4, falloff = 0.3 }
local volume = march { density = (ball + other) * 4, emission = vec(0.2, 0.2, 0.2) * ball, steps = 8, shadow_steps = 1 }
fx.output = final { volume.color }.color
return fx
"""
AIR = """
local fx = effect { name = "air", fps = 24, frames = 49 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, position = {0, 0, 0.2} }
air:source { shape = sphere { position = {0, 0, 0.6}, radius = 0.3 }, density = 1 }
fx.camera = orbit { target = {0, 0, 1}, distance = 8, pitch = 0 }
fx.output = final { march { density = air.density * 4, steps = 4, shadow_steps = 1 } }.color
return fx
"""


class Handles(Case):
    def stage(self, *args, effect=STAGE):
        live = self.live(*args, effect=effect)
        live.expect("live: shown")
        return live

    def shown(self, *args, effect=STAGE):
        live = self.stage(*args, effect=effect)
        live.keys("h")
        live.widget("handle sun.direction")
        return live

    def picture(self, live):
        return live.screenshot().crop(*live.widget(VIEW))

    def pull(self, live, name, x, y, keys=()):
        left, top = live.middle(name)
        for key in keys:
            live.tool("keydown", key)
        live.drag((left, top), (left + x, top + y), steps=12)
        for key in keys:
            live.tool("keyup", key)

    def last_set(self, live, name):
        """The numbers that a control was set to last, once the hand has let go."""
        for key, frame in (("Right", 2), ("Left", 1)):  # input is taken in order
            mark = live.mark()
            live.keys(key)
            live.expect(rf"live: (drew|shows) frame {frame}\b", mark)
        return [float(v) for v in [line for line in live.log if f"live: set {name} = " in line][-1].split("= ")[1].split(",")]

    def meter(self, live):
        """Pixels of a metre at the target, of a lens of 40 degrees at 8 m."""
        _, top, _, bottom = live.widget(VIEW)
        return (bottom - top) / (2 * 8 * 0.36397)

    def test_off_at_first(self):
        live = self.stage()
        plain = self.picture(live)
        self.assertFalse([name for name in live.widgets() if name.startswith("handle")])
        live.keys("h", "g")
        live.widget("handle ball.position")
        live.wait_until(lambda: difference(plain, self.picture(live)) > 60, "handles and a grid")
        live.keys("h", "g")
        live.wait_until(lambda: difference(plain, self.picture(live)) == 0, "the picture alone")
        live.quit()

    def test_never_in_files(self):
        live = self.stage()
        live.keys("F12")
        first = live.expect(r"live: wrote (.*\.png)").group(1)
        live.keys("h", "g")
        live.widget("handle ball.position")
        live.keys("F12")
        second = live.expect(r"live: wrote (.*\.png)").group(1)
        with open(os.path.join(self.folder, first), "rb") as a, open(os.path.join(self.folder, second), "rb") as b:
            self.assertEqual(a.read(), b.read())
        live.quit()

    def test_a_literal_goes_back_into_the_file(self):
        live = self.shown()
        before = self.picture(live)
        self.pull(live, "handle ball.position", 90, -45)
        at = self.last_set(live, "ball.position")
        self.assertAlmostEqual(at[0], 90 / self.meter(live), delta=0.05)
        self.assertAlmostEqual(at[1], 0, delta=0.01)
        self.assertAlmostEqual(at[2], 1 + 45 / self.meter(live), delta=0.05)
        self.assertGreater(difference(before, self.picture(live)), 20)
        live.keys("w")
        live.click_on("write")
        live.expect("live: wrote back 1")
        live.expect("live: took over")
        self.assertRegex(self.read("puff.lua"), r"sphere \{ position = \{%.2f\d*, [-\d.e]+, [\d.]+\}, radius = 0.6" % (int(at[0] * 100) / 100))
        live.keys("ctrl+z")
        live.expect("live: undid written: puff.lua")
        live.expect("live: took over")
        self.assertEqual(self.read("puff.lua"), STAGE)
        live.keys("ctrl+z")
        live.expect("live: undid ball.position")  # the whole drag at once
        live.keys("ctrl+z")
        live.expect("live: notice: Nothing to undo")
        live.quit()

    def test_along_an_axis_and_in_steps(self):
        live = self.shown()
        live.click_on("handle lamp.position")
        self.pull(live, "handle/z", 25, -40)
        at = self.last_set(live, "lamp.position")
        self.assertEqual(at[:2], [0, -1])
        self.assertGreater(at[2], 2.6)
        self.pull(live, "handle lamp.position", 60, -14, ["ctrl"])
        at = self.last_set(live, "lamp.position")
        self.assertGreater(at[0], 0.4)
        for value in at:  # half of the grid's 0.5 m
            self.assertAlmostEqual(value / 0.25, round(value / 0.25), delta=1e-4)
        self.pull(live, "handle lamp.position", 60, 0, ["shift"])
        self.assertEqual(self.last_set(live, "lamp.position")[2], at[2])
        live.quit()

    def test_parameters_lengths_and_the_sun(self):
        live = self.shown()
        self.pull(live, "handle other.position", -60, 0)  # a parameter says where it is
        at = self.last_set(live, "place")
        self.assertAlmostEqual(at[0], 1.6 - 60 / self.meter(live), delta=0.05)
        self.pull(live, "handle ball.radius", 50, 0)
        self.assertAlmostEqual(self.last_set(live, "ball.radius")[0], 0.6 + 50 / self.meter(live), delta=0.05)
        self.pull(live, "handle sun.direction", 30, -20)
        self.assertGreater(self.last_set(live, "sun.elevation")[0], 41)
        live.expect("live: set sun.azimuth = ", 0)
        live.keys("ctrl+z")
        live.expect(r"live: undid sun$")  # both angles
        live.keys("ctrl+z")
        live.expect("live: undid ball.radius")
        live.quit()

    def test_a_key_of_a_path(self):
        live = self.shown()
        self.pull(live, "handle way.key 2", 0, -50)
        live.expect(r"live: set way = linear 0 -2,0,2; 2 2\b[^,]*,[^,]+,2\.[3-9]")
        live.quit()

    def test_the_box_of_a_simulation(self):
        live = self.shown(effect=AIR)
        self.pull(live, "handle air.position", 80, 0)
        live.expect(r"live: set air.position = 0\.\d+,")  # once, when it is let go
        live.expect("live: took over")
        self.assertEqual(sum("live: set air.position" in line for line in live.log), 1)
        live.keys("w")
        live.click_on("write")
        live.expect("live: wrote back 1")
        self.assertRegex(self.read("puff.lua"), r"voxel_size = 0.1, position = \{0\.\d+, [-\d.e]+, 0\.2\}")
        live.quit()

    def test_what_is_under_the_pointer(self):
        live = self.stage()
        live.keys("d")
        left, top, right, bottom = live.widget(VIEW)
        live.tool("mousemove", round((left + right) / 2), round((top + bottom) / 2))
        at = live.expect(r"live: probed ([-\d.e]+),([-\d.e]+),([-\d.e]+) density ([1-9][\d.]*)").groups()
        for value, wanted in zip(at, (0, 0, 1, 4)):  # near the middle of a ball that is thin
            self.assertAlmostEqual(float(value), wanted, delta=0.3)
        live.widget("probe")
        live.tool("mousemove", round(left) + 20, round(top) + 20)
        live.expect("live: probed 0,0,0 density 0")
        live.keys("d")
        live.wait_until(lambda: "probe" not in live.widgets(), "the picture alone")
        live.quit()

    def test_keys_of_the_camera_that_one_looks_through(self):
        """Dragged, they move the view itself; written, the file says the path."""
        effect = STAGE.replace("orbit { target = {0, 0, 1}, distance = 8, pitch = 0 }", """camera {
  eye = curve { {0, {0, -8, 1}}, {1, {1.5, -4, 1}}, {2, {3, -2, 2}}, shape = "linear" },
  target = curve { {0, {0, 0, 1}}, {2, {-1, 0, 1.5}}, shape = "linear" },
}""")
        live = self.shown(effect=effect)
        live.wait_until(lambda: "handle camera_eye.key 2" in live.widgets(), "the keys")
        self.assertNotIn("handle camera_eye.key 1", live.widgets())  # in the eye
        before = self.picture(live)
        self.pull(live, "handle camera_eye.key 2", 0, -40)
        live.expect(r"live: set camera_eye = linear 0 0,-8,1; 1 [^;]*,1\.[1-9]\d*; 2 3,-2,2$")
        self.pull(live, "handle camera_target.key 1", 60, 0)
        live.expect(r"live: set camera_target = ")
        live.wait_until(lambda: difference(before, self.picture(live)) > 8, "another view")
        live.keys("w")
        live.click_on("write")
        live.expect("live: wrote back 2")
        text = self.read("puff.lua")
        self.assertRegex(text, r"eye = curve \{ \{0, \{0, -8, 1\}\}, \{1, \{1\.\d+, -4, 1\.\d+\}\}")
        self.assertNotIn("target = curve { {0, {0, 0, 1}}", text)
        live.quit()

    def test_without_perspective(self):
        live = self.shown("--set", "camera.pitch=20")
        before = live.middle("handle other.position")
        live.keys("3")
        live.expect(r"live: set camera.orthographic = 5\.8")
        live.expect("live: drew")
        live.wait_until(lambda: abs(live.middle("handle other.position")[1] - live.middle("handle ball.position")[1]) < 2,
                        "a view from above")
        live.keys("1")
        live.expect(r"live: set camera.eye = -?[\d.e-]+,-8,1$")
        left, top, right, _ = live.widget(VIEW)
        live.click((left + right) / 2, top + 40, 4)
        live.expect(r"live: set camera.orthographic = 5\.1")
        live.keys("0")
        live.expect("live: set camera.orthographic = 0")
        live.keys("r")
        live.wait_until(lambda: live.middle("handle other.position") == before, "the script's camera")
        live.quit()


require_tools()
main()
