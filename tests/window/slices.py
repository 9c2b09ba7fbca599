"""The window's tools for flows in slices: seen, pushed, captured as templates, and given these."""
import os
import subprocess

from lib.window import PATIENCE, RISE, Case, difference, main, require_tools


class Slices(Case):
    def open(self):
        live = self.live("--frame", "12", effect=RISE)
        live.keys("s")
        live.wait_until(lambda: self.sheet(live).colors() > 20, "the flow")
        return live

    @staticmethod
    def sheet(live):
        place = live.widget("slices/sheet")
        return live.screenshot().crop(*place)

    @staticmethod
    def place(live, x, y):
        """Pixel of a place in the slice, in shares of its width and height from the lower left."""
        left, top, right, bottom = live.widget("slices/sheet")
        return left + (right - left) * x, bottom - (bottom - top) * y

    def see(self, live, field):
        before = self.sheet(live)
        live.click_on("slices/view")
        live.click_on(f"slices/{field}")
        live.tool("mousemove", 5, 5)
        live.wait_until(lambda: difference(before, self.sheet(live)) > 60, f"the {field}")

    def clipboard(self):
        return subprocess.run(["xclip", "-o", "-selection", "clipboard"], env=self.environment,
                              check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True, timeout=PATIENCE).stdout

    def test_it_is_pushed_where_the_pointer_goes(self):
        live = self.open()
        self.see(live, "velocity")
        live.drag(self.place(live, 0.3, 0.8), self.place(live, 0.7, 0.8))
        push = live.expect(r"live: pushed air at (\S+) (\S+) by (\S+) (\S+)")
        x, y, right, up = (float(text) for text in push.groups())
        self.assertTrue(0.2 < x < 0.8 and 0.75 < y < 0.85, push.group(0))
        self.assertTrue(right > 5 * abs(up), push.group(0))
        live.tool("mousemove", 5, 5)
        before = self.sheet(live)
        live.keys("Right")
        live.expect(r"live: drew frame 13\b")
        live.wait_until(lambda: difference(before, self.sheet(live)) > 60, "another flow")
        seen = self.sheet(live)
        red, green, blue = seen.crop(*self.box(seen, 0.45, 0.75, 0.6, 0.85)).mean()
        self.assertTrue(red > green + 10 and red > blue + 10, (red, green, blue))  # to the right
        live.quit()

    @staticmethod
    def box(picture, left, low, right, high):
        return (picture.width * left, picture.height * (1 - high), picture.width * right, picture.height * (1 - low))

    def test_a_template_is_captured_put_and_said(self):
        live = self.open()
        self.see(live, "pressure")
        live.click_on("slices/select")
        live.widget("slices/capture")
        live.drag(self.place(live, 0.3, 0.1), self.place(live, 0.7, 0.5))
        live.click_on("slices/template name")
        live.type("mine")
        live.click_on("slices/capture")
        live.expect(r"live: captured templates/mine\.exr")
        with open(self.path("templates/mine.exr"), "rb") as f:
            captured = f.read()
        live.keys("ctrl+z")  # it is a step like others
        live.expect("live: undid captured mine")
        self.assertFalse(os.path.exists(self.path("templates/mine.exr")))
        live.keys("ctrl+y")
        live.expect("live: redid captured mine")
        with open(self.path("templates/mine.exr"), "rb") as f:
            self.assertEqual(f.read(), captured)
        self.assertTrue(os.path.getsize(self.path("templates/mine.exr")) > 1000)
        live.widget("slices/mine.exr")  # its icon
        live.click(*self.place(live, 0.5, 0.7))
        live.expect(r"live: put mine\.exr at 0\.5\d* 0\.7\d*|live: put mine\.exr at 0\.49\d* 0\.\d+")
        live.click_on("slices/copy as lua")
        line = live.expect(r"live: line (air:templates \{.*\})").group(1)
        self.assertIn('image "templates/mine.exr", kind = "pressure"', line)
        live.wait_until(lambda: self.clipboard().strip() == line, "the line to be pasted")
        self.write("puff.lua", RISE.replace("fx.camera", line + "\nfx.camera"))
        live.expect("live: took over")
        live.quit()

    def test_what_is_there_is_not_replaced(self):
        self.write("templates/mine.exr", "what someone made")
        live = self.open()
        live.click_on("slices/select")
        live.widget("slices/capture")
        live.drag(self.place(live, 0.3, 0.1), self.place(live, 0.7, 0.5))
        live.click_on("slices/template name")
        live.type("mine")
        live.click_on("slices/capture")
        live.expect(r"live: templates/mine\.exr is there already")
        self.assertEqual(self.read("templates/mine.exr"), "what someone made")
        live.quit()

    def test_a_template_of_the_library_acts(self):
        live = self.open()
        self.see(live, "velocity")
        live.click_on("slices/put")
        live.click_on("slices/jet.exr")
        live.click(*self.place(live, 0.5, 0.8))
        live.expect(r"live: put jet\.exr")
        live.tool("mousemove", 5, 5)
        before = self.sheet(live)
        live.keys("Right")
        live.expect(r"live: drew frame 13\b")
        live.wait_until(lambda: difference(before, self.sheet(live)) > 60, "what it does")
        self.assertFalse(os.path.exists(self.path("templates")))
        live.click_on("slices/copy as lua")  # now the effect is to read it
        live.wait_until(lambda: os.path.exists(self.path("templates/jet.exr")), "a copy")
        live.quit()


require_tools()
main()
