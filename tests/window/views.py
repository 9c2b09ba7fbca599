"""What lies over the picture: the inspector, the performance view, the range that is looped."""
from lib.window import Case, difference, main, require_tools

GLOW = """
local fx = effect { name = "glow", fps = 24, frames = 48 }
local ball = sphere { position = {0, 0, 1}, radius = 1, falloff = 0.6 }
local volume = march { density = ball * 4, steps = 8, shadow_steps = 1 }
local glow = bloom { volume.color }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 10 }
fx.output = final { volume.color, glow.color }.color
return fx
"""


class Views(Case):
    @staticmethod
    def picture(live, name):
        place = live.widget(name)  # before the picture is taken: it is there by then
        return live.screenshot().crop(*place)

    def comes(self, live, name, before, what):
        live.wait_until(lambda: difference(before, self.picture(live, name)) > 20, what)
        return self.picture(live, name)

    def drawn(self, live):
        picture = self.picture(live, "inspected")
        if picture.colors() <= 50 or difference(picture, self.picture(live, "inspected")) > 0:
            return None  # not there, or not yet as it stays
        return picture

    def test_inspector(self):
        live = self.live(effect=GLOW)
        live.keys("i")
        fitted = live.wait_until(lambda: self.drawn(live), "an image")
        left, top, right, bottom = live.widget("inspected")
        live.click((left + right) / 2, top + (bottom - top) * 0.3, button=4)
        nearer = self.comes(live, "inspected", fitted, "a nearer look")
        live.drag(((left + right) / 2, (top + bottom) / 2), (left + 40, top + 40))
        aside = self.comes(live, "inspected", nearer, "another part")
        live.click_on("fit")
        self.comes(live, "inspected", aside, "another view")
        live.tool("mousemove", 5, 5)  # else what it does is said over the image
        live.wait_until(lambda: difference(fitted, self.picture(live, "inspected")) < 3, "all of it")
        live.click_on("r")
        self.comes(live, "inspected", fitted, "fewer channels")
        live.quit()

    def test_an_image_goes_and_comes_back(self):
        live = self.live(effect=GLOW)
        live.keys("i")
        final = live.wait_until(lambda: self.drawn(live), "an image")
        left, top, right, bottom = live.widget("image")
        live.click((left + right) / 2, (top + bottom) / 2)
        words = self.comes(live, "inspected", final, "the names of images")
        live.click_on("bloom.color")
        self.comes(live, "inspected", words, "an image")
        self.comes(live, "inspected", final, "the glow, in the place of the picture")
        before = self.picture(live, "inspected")
        plain = GLOW.replace(", glow.color", "").replace("local glow = bloom { volume.color }\n", "")
        self.write("puff.lua", plain)
        live.expect("live: took over")
        live.wait_until(lambda: "level" not in live.widgets(), "the word that it is gone")
        self.write("puff.lua", GLOW)
        live.expect("live: took over")
        live.wait_until(lambda: "level" in live.widgets(), "the image")
        live.wait_until(lambda: difference(before, self.picture(live, "inspected")) < 3, "the same")
        live.quit()

    def test_performance(self):
        live = self.live(effect=GLOW)
        live.keys("p")
        empty = self.picture(live, "history")
        for frame in range(2, 6):
            live.keys("Right")
            live.expect(rf"live: drew frame {frame}\b")
        self.comes(live, "history", empty, "the times")
        left, top, right, bottom = live.widget("passes")
        self.assertEqual(round((bottom - top) / 22), 4)  # march.bricks, march, bloom, final
        live.quit()

    def test_a_range_is_looped(self):
        live = self.live(effect=GLOW)
        left, top, right, bottom = live.widget("timeline")
        before, middle = self.picture(live, "timeline"), (top + bottom) / 2
        live.tool("keydown", "shift")
        live.drag((left + (right - left) * 0.25, middle), (left + (right - left) * 0.5, middle))
        live.tool("keyup", "shift")
        self.comes(live, "timeline", before, "a range")
        live.keys("Home")
        first = int(live.expect(r"live: drew frame (\d+)").group(1))
        live.keys("End")
        last = int(live.expect(r"live: drew frame (\d+)").group(1))
        self.assertTrue(10 <= first < last <= 26, (first, last))
        live.quit()


require_tools()
main()
