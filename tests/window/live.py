"""`roil live` as its user meets it: the keys, the panel, the files."""
import os
import re
import subprocess

from lib.window import PATIENCE, PROGRAM, PUFF, Case, difference, main, require_tools

SPARKS = """
local fx = effect { name = "sparks", fps = 24, frames = 480 }
fx.camera = camera { eye = {0, -5, 0}, target = {0, 0, 0}, fov = 20 }
local one = particles { count = 4, burst = 4, lifetime = 8, radius = 0.5 }
fx.output = splats { one, size = over_age { {0, 0.1}, {1, 0.4} } }.image
return fx
"""
FLOOR = "v -40 -40 0\nv 40 -40 0\nv 40 40 0\nv -40 40 0\nf 1 2 3 4\n"
ON_FLOOR = """
local fx = effect { name = "floor", fps = 24, frames = 48 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 20 }
fx.output = final { shade { from = geometry { mesh { "floor.obj", position = {0, 0, 0.5} } } } }.color
return fx
"""
VIEW = "view"  # the widget that stands for the picture


class Keys(Case):
    def test_help_panel_and_quit(self):
        live = self.live()
        live.expect("live: shown")
        plain = live.screenshot()
        live.keys("F1")
        live.widget("help")
        live.wait_until(lambda: difference(plain, live.screenshot()) > 60, "the help in the picture")
        live.keys("Escape")
        live.wait_until(lambda: "help" not in live.widgets(), "the end of the help")
        wide = live.widget(VIEW)[2]
        live.keys("Tab")
        live.wait_until(lambda: live.widgets().get(VIEW, [0, 0, 0, 0])[2] > wide, "the wide picture")
        live.keys("Tab")
        live.wait_until(lambda: live.widgets().get(VIEW, [0, 0, 0, 0])[2] == wide, "the panel")
        live.quit()

    def test_time(self):
        live = self.live()
        live.keys("Right")
        live.expect(r"live: drew frame 2\b")
        live.keys("End")
        live.expect(r"live: drew frame 48\b")
        live.keys("Home")
        live.expect(r"live: shows frame 1\b")  # its picture was kept
        live.keys("space")
        for frame in (2, 3):
            live.expect(r"live: drew frame ")
        live.keys("space")
        live.quit()

    def test_scrub(self):
        live = self.live()
        left, top, right, bottom = live.widget("timeline")
        middle = (top + bottom) / 2
        live.drag((left + 20, middle), ((left + right) / 2, middle))
        frame = live.wait_until(lambda: 20 < self.frame(live) < 29, "the middle of the time")
        self.assertTrue(frame)
        live.quit()

    @staticmethod
    def frame(live):
        drawn = [m for m in (re.search(r"live: drew frame (\d+)", line) for line in live.log) if m]
        return int(drawn[-1].group(1))

    def test_a_shot_can_be_rendered_again(self):
        live = self.live("--set", "thickness=9")
        live.expect("live: shown")
        live.keys("Right", "F12")
        shot = live.expect(r"live: wrote (\S+\.png)").group(1)
        live.quit()
        subprocess.run([PROGRAM, "render", "--from", shot, "-o", "again.png"], cwd=self.folder,
                       env=self.environment, check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)
        compare = os.path.join(os.path.dirname(PROGRAM), "golden_compare")
        same = subprocess.run([compare, shot, "again.png", "difference.png"], cwd=self.folder,
                              check=False, stdout=subprocess.PIPE, text=True, timeout=PATIENCE)
        self.assertEqual(same.returncode, 0, same.stdout)


class Reference(Case):
    def test_samples_are_gathered_while_time_stands(self):
        live = self.live(effect=PUFF.replace("march {", "reference {").replace("steps = steps, shadow_steps = 1", "samples = 1"))
        for _ in range(4):
            live.expect(r"live: drew frame 1\b", live.mark())
        live.quit()


class Camera(Case):
    def test_orbit_zoom_and_back(self):
        live = self.live()
        live.expect("live: shown")
        first = live.screenshot().crop(*live.widget(VIEW))
        left, top, right, bottom = live.widget(VIEW)
        middle = ((left + right) / 2, (top + bottom) / 2)
        mark = live.mark()
        live.drag(middle, (middle[0] + 150, middle[1] + 60))
        live.expect(r"live: set camera\.eye = ", mark)
        live.click(*middle, button=4)
        live.expect(r"live: set camera\.eye = ")
        live.wait_until(lambda: difference(first, live.screenshot().crop(left, top, right, bottom)) > 20,
                        "another view")
        live.keys("f")
        live.expect(r"live: set camera\.eye = ")
        live.keys("r")
        live.expect(r"live: reset camera")
        live.wait_until(lambda: difference(first, live.screenshot().crop(left, top, right, bottom)) < 3,
                        "the script's view")
        live.quit()


    def eye(self, live, drag):
        """Where the camera stands after a drag of so many pixels, from the middle."""
        left, top, right, bottom = live.widget(VIEW)
        middle = ((left + right) / 2, (top + bottom) / 2)
        mark = live.mark()
        live.drag(middle, (middle[0] + drag[0], middle[1] + drag[1]))
        live.expect(r"live: set camera\.target = ", mark)
        live.expect(r"live: drew frame", mark)
        return [float(v) for v in live.expect(r"live: set camera\.eye = (\S+)", mark).group(1).split(",")]

    def test_the_ground_stops_the_camera(self):
        self.write("floor.obj", FLOOR)
        live = self.live(effect=ON_FLOOR)
        live.expect("live: shown")
        self.assertGreater(self.eye(live, (0, -250))[2], 0.5)
        self.assertGreater(self.eye(live, (40, -40))[2], 0.5)
        live.quit()


class Panel(Case):
    def picture(self, live):
        return live.screenshot().crop(*live.widget(VIEW))

    def changes(self, live, before):
        live.wait_until(lambda: difference(before, self.picture(live)) > 8, "a change of the picture")

    def test_slider(self):
        live = self.live()
        live.expect("live: shown")
        before = self.picture(live)
        left, top, right, bottom = live.widget("thickness")
        middle = (top + bottom) / 2
        live.drag((left + (right - left) * 0.2, middle), (left + (right - left) * 0.75, middle))
        value = float(live.wait_until(lambda: self.last_set(live, "thickness"), "a value"))
        live.wait_until(lambda: 13 < float(self.last_set(live, "thickness")) < 17,
                        "three quarters of the range")
        self.assertGreater(value, 0)
        self.changes(live, before)
        live.quit()

    @staticmethod
    def last_set(live, name):
        found = [m for m in (re.search(rf"live: set {name} = (.*)", line) for line in live.log) if m]
        return found[-1].group(1) if found else None

    def test_a_search_begins_at_its_top(self):
        live = self.live("--paused")
        live.tool("mousemove", *(round(v) for v in live.middle("panel")), "click", "--repeat", 15, "--delay", 20, 5)
        live.wait_until(lambda: live.widgets()["thickness"][3] < 0, "the end of the panel")
        live.click_on("search")
        live.type("s")  # finds more than there is room for
        live.wait_until(lambda: live.widgets().get("steps", [0, -1])[1] > live.widgets()["search"][3], "its first row")
        live.quit()

    def test_search_leaves_what_matches(self):
        live = self.live()
        live.widget("thickness")
        live.click_on("search")
        live.type("edge")
        live.wait_until(lambda: "look" in live.widgets() and "thickness" not in live.widgets(),
                        "only what matches")
        live.quit()

    def test_structure_is_built_in_the_background(self):
        live = self.live()
        live.expect("live: shown")
        before = self.picture(live)
        live.click_on("look")
        live.keys("Down", "Return")
        live.expect(r"live: took over")
        self.changes(live, before)
        live.quit()

    def test_palette(self):
        live = self.live()
        live.expect("live: shown")
        before = self.picture(live)
        left, top, right, bottom = live.widget("fire/stops")
        width, middle = right - left, (top + bottom) / 2
        live.drag((left + width * 0.4, middle), (left + width * 0.15, middle))
        live.wait_until(lambda: self.last_set(live, "fire"), "the palette's text")
        live.wait_until(lambda: abs(float(self.last_set(live, "fire").split(";")[1].split()[0]) - 0.15) < 0.05,
                        "the stop where it was dropped")
        self.changes(live, before)
        live.quit()

    def test_a_number_over_age_is_edited_by_age(self):
        """As a curve from 0 to 1, however long the effect is."""
        live = self.live(effect=SPARKS)
        live.expect("live: shown")
        left, top, right, bottom = live.widget("size/plot")
        live.tool("mousemove", round((left + right) / 2), round((top + bottom) / 2), "click", "--repeat", 2, "--delay", 60, 1)
        keys = live.wait_until(lambda: self.last_set(live, "size"), "the curve's text").split("; ")
        self.assertEqual(keys[0], "linear 0 0.1")
        self.assertEqual(keys[2], "1 0.4")
        self.assertTrue(0.4 < float(keys[1].split()[0]) < 0.65, keys)
        live.quit()

    def clipboard(self):
        return subprocess.run(["xclip", "-o", "-selection", "clipboard"], env=self.environment,
                              check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True, timeout=PATIENCE).stdout

    def test_a_value_is_copied_as_lua(self):
        live = self.live("--set", "thickness=7.5")
        live.click_on("thickness", button=3)
        live.click_on("thickness/copy as lua")
        text = live.wait_until(self.clipboard, "what was copied")
        self.assertTrue(text.startswith('param { "thickness", 7.5, min = 0, max = 20, unit = "1/m"'), text)
        live.wait_until(lambda: "thickness/copy name" not in live.widgets(), "the end of the menu")
        live.click_on("thickness/reset")  # the button beside the label
        live.expect("live: reset thickness")
        live.quit()

    def test_presets_are_loaded_and_overwritten(self):
        self.write("puff.presets/thick.lua", "return { thickness = 12, gone = 1 }")
        live = self.live()
        live.expect("live: shown")
        before = self.picture(live)
        live.click_on("preset")
        live.click_on("thick")
        live.expect("live: set thickness = 12")
        self.changes(live, before)
        live.click_on("preset save")  # asks first
        self.assertIn("gone", self.read("puff.presets/thick.lua"))
        live.click_on("preset save")
        live.wait_until(lambda: "gone" not in self.read("puff.presets/thick.lua"), "the new preset")
        self.assertIn("thickness = 12", self.read("puff.presets/thick.lua"))
        live.quit()

    def test_preset(self):
        live = self.live("--set", "thickness=11")
        live.click_on("preset name")
        live.type("thick")
        live.click_on("preset save")
        live.wait_until(lambda: os.path.exists(self.path("puff.presets/thick.lua")), "the preset")
        with open(self.path("puff.presets/thick.lua"), encoding="utf-8") as f:
            self.assertIn("thickness = 11", f.read())
        live.quit()
        again = self.live("--preset", "thick", effect=None)
        with_preset = again.screenshot().crop(*again.widget(VIEW))
        again.quit()
        plain = self.live(effect=None)
        self.assertGreater(difference(with_preset, plain.screenshot().crop(*plain.widget(VIEW))), 8)
        plain.quit()


AIR = """
local fx = effect { name = "air", fps = 24, frames = 24000 }
fx.camera = orbit { target = {0, 0, 0.8}, distance = 4 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1 }
fx.output = final { march { density = air.density * 30, steps = 8 } }.color
return fx
"""


class Simulation(Case):
    def test_a_long_way_can_be_left(self):
        live = self.live(effect=AIR)
        live.keys("End")
        live.expect(r"live: drew frame 24000\b")
        live.keys("Escape")
        reached = float(live.expect(r"live: notice: Stopped at (\d+\.\d+) s").group(1))
        self.assertLess(reached, 900)
        frame = int(live.expect(r"live: drew frame (\d+)").group(1))
        self.assertLess(abs(frame - reached * 24 - 1), 1.5)
        live.quit()


class Files(Case):
    def test_a_number_and_a_broken_file(self):
        live = self.live()
        live.expect("live: shown")
        before = live.screenshot().crop(*live.widget(VIEW))
        self.write("puff.lua", PUFF.replace('"thickness", 4', '"thickness", 15'))
        live.expect("live: took over")
        live.wait_until(lambda: difference(before, live.screenshot().crop(*live.widget(VIEW))) > 8,
                        "the new number")
        good = live.screenshot().crop(*live.widget(VIEW))
        self.write("puff.lua", PUFF.replace("march {", "marsh {"))
        live.expect(r"live: puff\.lua:\d+: .*marsh")
        card = live.widget("message")
        view = live.widget(VIEW)
        above = [view[0], view[1], view[2], card[1] - 8]
        self.assertLess(difference(good.crop(0, 0, view[2] - view[0], card[1] - 8 - view[1]),
                                   live.screenshot().crop(*above)), 3)
        self.write("puff.lua", PUFF)
        live.expect("live: took over")
        live.wait_until(lambda: "message" not in live.widgets(), "the end of the message")
        live.quit()

    def test_a_number_that_moves_too_far(self):
        live = self.live(effect=PUFF.replace("steps = steps", "steps = thickness * 0"))
        card = live.widget("warning")
        live.expect(r"warning: puff\.lua:\d+: march: uniform 'steps' is 0", mark=0)  # when it was rehearsed
        self.assertGreater(live.screenshot().crop(*card).colors(), 20)  # letters
        self.write("puff.lua", PUFF.replace("steps = steps", "steps = thickness - 3"))
        live.expect("live: took over")
        live.wait_until(lambda: "warning" not in live.widgets(), "the end of the warning")
        live.quit()

    def test_broken_from_the_start(self):
        self.write("puff.lua", "local x = ")
        from lib.window import Live
        live = Live(self, "puff.lua", "--size", "1200x720")
        self.addCleanup(live.kill)
        live.expect(r"live: puff\.lua:1: ")
        live.widget("message")
        self.write("puff.lua", PUFF)
        live.expect("live: took over")
        live.expect("live: drew frame")
        live.quit()

    def test_an_endless_loop_stops_nothing(self):
        live = self.live()
        self.write("puff.lua", PUFF.replace("return fx", "fx.update = function() while true do end end\nreturn fx"))
        live.expect(r"live: .*instruction limit")
        live.keys("Right")
        live.expect(r"live: drew frame 2\b")
        live.quit()


# Takes minutes, when it is asked to. llvmpipe ends every loop after 65535 turns, so each is long.
SPIN = """
// Draws its source again, late.
uniform int turns; //= 0 [0, 1000000] : how late
uniform sampler2D source; //= input : the picture
writeonly uniform image2D color; //= output rgba16f : it again
layout(local_size_x = 8, local_size_y = 8) in;
#define ONE(k) sum = fract(sum * 1.1 + texelFetch(source, (p + ivec2(i + k, k)) % 64, 0));
#define EIGHT(k) ONE(k) ONE(k + 1) ONE(k + 2) ONE(k + 3) ONE(k + 4) ONE(k + 5) ONE(k + 6) ONE(k + 7)
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    vec4 sum = texelFetch(source, p, 0);
    for (int i = 0; i < turns; i++) { EIGHT(0) EIGHT(8) EIGHT(16) EIGHT(24) EIGHT(32) EIGHT(40) }
    imageStore(color, p, sum);
}
"""


class Hang(Case):
    """A shader that does not end: the program says so, begins anew, and draws what is mended."""

    def test_it_begins_anew(self):
        self.write("spin.comp", SPIN)
        spinning = PUFF.replace("final { volume.color }", 'final { shader { "spin.comp", volume.color, turns = %d }.color }')
        live = self.live("--timeout", "2", effect=spinning % 0)
        live.keys("Right")
        live.expect(r"live: drew frame 2\b")
        self.write("puff.lua", spinning % 60000)
        live.expect(r"was lost in pass 'spin'.*restarts")
        live.expect("live: took over")
        live.widget("message")
        self.write("puff.lua", spinning % 0)
        live.expect(r"live: drew frame 2\b")
        live.wait_until(lambda: "message" not in live.widgets(), "the end of the message")
        live.quit()


class Window(Case):
    def test_sizes(self):
        live = self.live()
        live.expect("live: shown")
        for width, height in ((700, 500), (1, 1), (1500, 900), (300, 5), (1200, 720)):
            live.tool("windowsize", live.window(), width, height)
        live.wait_until(lambda: live.widgets().get(VIEW, [0] * 4)[3] > 500, "the size at the end")
        live.tool("windowunmap", "--sync", live.window())
        number = live.tool("search", "--name", "roil").split()[0]
        live.tool("windowmap", "--sync", number)
        live.expect("live: shown", live.mark())
        live.quit()

    def test_it_is_found_as_it_was_left(self):
        live = self.live()
        live.widget("thickness")
        live.tool("windowsize", "--sync", live.window(), 1000, 640)
        live.keys("p")
        live.widget("performance")
        live.quit()
        from lib.window import Live
        again = Live(self, "puff.lua", "--paused")
        self.addCleanup(again.kill)
        again.expect("live: first frame")
        again.widget("performance")
        shot = again.screenshot()
        self.assertEqual((shot.width, shot.height), (1000, 640))
        again.quit()

    def test_one_that_was_larger_than_the_display_fits_it(self):
        live = self.live()
        live.widget("thickness")
        live.tool("windowsize", "--sync", live.window(), 2000, 1300)
        live.wait_until(lambda: live.widgets().get(VIEW, [0] * 4)[3] > 1000, "the larger size")
        live.quit()
        from lib.window import SCREEN, Live
        again = Live(self, "puff.lua", "--paused")
        self.addCleanup(again.kill)
        again.expect("live: first frame")
        shot = again.screenshot()
        self.assertEqual((shot.width, shot.height), SCREEN)
        again.quit()

    def test_without_a_display(self):
        self.write("puff.lua", PUFF)
        environment = {k: v for k, v in self.environment.items() if k != "DISPLAY"}
        done = subprocess.run([PROGRAM, "live", "puff.lua"], cwd=self.folder, env=environment,
                              check=False, stderr=subprocess.PIPE, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 1)
        self.assertIn("display", done.stderr)
        self.assertIn("roil render", done.stderr)


require_tools()
main()
