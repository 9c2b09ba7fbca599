"""What hands did is undone, done again, and written into the file."""
import os
import random
import re
import subprocess

from lib.window import PROGRAM, PUFF, Case, Live, difference, main, require_tools

VIEW = "view"
ACTIONS = int(os.environ.get("ROIL_SOAK") or 40)  # at random; 5000 take over an hour in software
CHOSEN = r"fire/(color|alpha|position|swatch)|(colour|alpha|position)/label"  # of a chosen stop: is no step


class Undo(Case):
    def picture(self, live):
        return live.screenshot().crop(*live.widget(VIEW))

    def looks_like(self, live, picture, what):
        live.wait_until(lambda: difference(picture, self.picture(live)) < 3, what)

    def slide(self, live, name, start, end):
        left, top, right, bottom = live.widget(name)
        middle = (top + bottom) / 2
        live.drag((left + (right - left) * start, middle), (left + (right - left) * end, middle))

    def turn(self, live, x, y):
        left, top, right, bottom = live.widget(VIEW)
        middle = ((left + right) / 2, (top + bottom) / 2)
        live.drag(middle, (middle[0] + x, middle[1] + y))

    def settled(self, live):
        """The picture once all that was done before has come to it: input is taken in order."""
        for key, frame in (("Right", 2), ("Left", 1)):
            mark = live.mark()
            live.keys(key)
            live.expect(rf"live: (drew|shows) frame {frame}\b", mark)
        live.expect("live: shown")
        return self.picture(live)

    def test_a_gesture_at_a_time(self):
        live = self.live()
        live.expect("live: shown")
        first = self.picture(live)
        self.slide(live, "thickness", 0.2, 0.75)
        thick = self.settled(live)
        self.assertGreater(difference(first, thick), 8)
        self.turn(live, 150, 60)
        self.slide(live, "fire/stops", 0.4, 0.15)
        self.assertEqual(self.read("puff.lua"), PUFF)
        for label in ("fire", "camera"):
            live.keys("ctrl+z")
            live.expect(f"live: undid {label}")
        self.looks_like(live, thick, "the picture before the camera was turned")
        live.keys("ctrl+z")
        live.expect("live: undid thickness")
        self.looks_like(live, first, "the first picture")
        live.wait_until(lambda: "thickness/reset" not in live.widgets(), "the script's value")
        live.keys("ctrl+y")
        live.expect("live: redid thickness")
        self.looks_like(live, thick, "the picture again")
        live.keys("u")  # the list: the newest on top
        live.click_on("as it was at first")
        live.expect("live: undid thickness")
        live.keys("u")
        self.looks_like(live, first, "the first picture")
        live.quit()

    def test_across_a_reload(self):
        live = self.live()
        live.expect("live: shown")
        live.click_on("look")  # structure
        live.keys("Down", "Return")
        live.expect("live: took over")
        self.slide(live, "thickness", 0.2, 0.75)
        self.write("puff.lua", PUFF.replace("steps = steps, shadow_steps = 1", "steps = steps, shadow_steps = 2"))
        live.expect("live: took over")
        live.keys("ctrl+z")
        live.expect("live: undid thickness")
        live.keys("ctrl+z")
        live.expect("live: undid look")
        live.expect("live: took over")
        live.wait_until(lambda: "look/reset" not in live.widgets(), "the script's word")
        live.quit()

    def test_a_bundle_is_shown_and_never_changed(self):
        self.write("show/puff.lua", PUFF)
        subprocess.run([PROGRAM, "bundle", "show/puff.lua", "-o", "puff.roil"], cwd=self.folder, env=self.environment, check=True)
        before = sorted(os.listdir(self.folder))
        with open(self.path("puff.roil"), "rb") as f:
            packed = f.read()
        live = Live(self, "puff.roil", "--size", "1200x720", "--paused")
        self.addCleanup(live.kill)
        live.expect("live: first frame")
        live.tool("windowfocus", "--sync", live.window())
        live.expect("live: shown")
        self.slide(live, "thickness", 0.2, 0.75)
        live.keys("w")
        live.expect("live: notice: puff.roil is a bundle, which is never changed")
        live.keys("ctrl+s")
        live.expect("live: notice: .*puff.roil is a bundle, which is never changed")
        live.quit()
        with open(self.path("puff.roil"), "rb") as f:
            self.assertEqual(f.read(), packed)
        self.assertEqual([name for name in sorted(os.listdir(self.folder)) if name not in ("state", "widgets.json")],
                         [name for name in before if name not in ("state", "widgets.json")])

    def test_what_was_tuned_goes_into_the_file(self):
        live = self.live()
        live.expect("live: shown")
        self.slide(live, "thickness", 0.2, 0.75)
        self.turn(live, 150, 60)
        tuned = self.settled(live)
        live.keys("w")
        live.click_on("cancel")
        live.wait_until(lambda: "cancel" not in live.widgets(), "the end of the question")
        self.assertEqual(self.read("puff.lua"), PUFF)
        live.keys("w")
        live.click_on("write")
        live.expect(r"live: wrote back 2")
        live.expect("live: took over")
        text = self.read("puff.lua")
        self.assertRegex(text, r'param \{ "thickness", 1\d\.\d+, min = 0, max = 20, unit = "1/m", help = "of the smoke" \}')
        self.assertRegex(text, r"orbit \{ target = \{0, 0, 1\}, distance = 6, pitch = [\d.-]+, yaw = [\d.-]+ \}")
        differs = [a != b for a, b in zip(text.splitlines(), PUFF.splitlines())]
        self.assertEqual((sum(differs), len(differs)), (2, len(PUFF.splitlines())))
        live.wait_until(lambda: "thickness/reset" not in live.widgets(), "the file's value")
        live.wait_until(lambda: difference(tuned, self.picture(live)) < 8, "the same picture")
        live.keys("ctrl+z")
        live.expect("live: undid written: puff.lua")
        live.expect("live: took over")
        self.assertEqual(self.read("puff.lua"), PUFF)
        live.widget("thickness/reset")  # it is set, as before
        self.looks_like(live, tuned, "the same picture")
        live.keys("ctrl+y")
        live.expect("live: redid written: puff.lua")
        live.expect("live: took over")
        self.assertEqual(self.read("puff.lua"), text)
        live.keys("u")
        live.click_on("0/thickness")  # two steps at once: the second waits until the file is loaded
        live.expect("live: undid written: puff.lua")
        live.expect("live: undid camera")
        live.widget("thickness/reset")  # that alone is set again
        live.click_on("as it was at first")
        live.expect("live: undid thickness")
        live.wait_until(lambda: "thickness/reset" not in live.widgets(), "the script's value")
        self.assertEqual(self.read("puff.lua"), PUFF)
        live.quit()

    def test_one_value_alone(self):
        live = self.live("--set", "thickness=7.5", "--set", "size=2")
        live.click_on("thickness", button=3)
        live.click_on("thickness/write into the file")
        live.click_on("write")
        live.expect("live: wrote back 1")
        self.assertEqual(self.read("puff.lua"), PUFF.replace('"thickness", 4', '"thickness", 7.5'))
        live.quit()

    def test_a_number_of_a_field_is_turned_and_becomes_a_parameter(self):
        """Nobody has declared it: the script's name is in front of it, and a pin writes it into the file."""
        rough = PUFF.replace("local ball = ", "local lumps = worley { frequency = 3 }\nlocal ball = ")
        rough = rough.replace("falloff = edge }", "falloff = edge } * lumps:remap(0, 1, 0.5, 1)")
        live = self.live(effect=rough)
        live.expect("live: shown")
        first = self.picture(live)
        live.click_on("search")
        live.type("frequency")
        live.wait_until(lambda: live.widgets().get("lumps.frequency", [0, 999])[1] < 200, "it below the search")
        left, top, right, bottom = live.widget("lumps.frequency")
        live.drag(((left + right) / 2, (top + bottom) / 2), ((left + right) / 2 + 60, (top + bottom) / 2))
        live.expect(r"live: set lumps\.frequency = ")
        self.assertGreater(difference(first, self.settled(live)), 8)
        live.keys("ctrl+z")
        live.expect(r"live: undid lumps\.frequency")
        live.click_on("lumps.frequency", button=3)
        live.click_on("lumps.frequency/make it a parameter")
        live.click_on("write")
        live.expect("live: wrote back 1")
        live.expect("live: took over")
        self.assertRegex(self.read("puff.lua"), r'worley \{ frequency = param \{ "\w+", 3')
        live.keys("ctrl+z")
        live.expect("live: undid written: ")
        live.expect("live: took over")
        self.assertEqual(self.read("puff.lua"), rough)
        self.looks_like(live, first, "the first picture")
        live.quit()

    def test_a_curve(self):
        live = self.live("--frame", "37")
        live.expect("live: shown")
        first = self.picture(live)
        live.click_on("search")
        live.type("swell")
        live.wait_until(lambda: live.widgets().get("swell/plot", [0, 0, 0, 999])[3] < 400, "it below the search")
        left, top, right, bottom = live.widget("swell/plot")
        live.tool("mousemove", round(left + (right - left) * 0.7), round(bottom - 50), "click", "--repeat", 2, "--delay", 60, 1)
        live.expect(r"live: set swell = cubic 0 0\.6; 1 1; 1\.\d+ 0\.\d+; 2 0\.8")
        live.wait_until(lambda: difference(first, self.picture(live)) > 8, "a smaller ball")
        live.keys("ctrl+z")
        live.expect("live: undid swell")
        self.looks_like(live, first, "the first picture")
        live.quit()

    def test_layers_come_and_go(self):
        """A click shows what it would write; written, the picture follows, and it can be undone."""
        lumpy = PUFF.replace("local swell", "local lumps = layers { {2, 1}, seed = 3 } -- of the smoke\nlocal swell")
        lumpy = lumpy.replace("ball * thickness", "ball * lumps:remap(0.4, 0.6, 0, 1) * thickness")
        live = self.live(effect=lumpy)
        live.expect("live: shown")
        first = self.picture(live)
        live.click_on("search")
        live.type("lumps")
        live.wait_until(lambda: live.widgets().get("lumps.scale_1", [0, 999])[1] < 200, "it below the search")
        self.slide(live, "lumps.strength_1", 0.2, 0.8)
        live.expect(r"live: set lumps\.strength_1 = ")
        live.click_on("lumps.3/add a layer")
        live.click_on("write")
        live.expect("live: wrote back 1")
        live.expect("live: took over")
        text = self.read("puff.lua")
        self.assertRegex(text, r"layers \{ \{2, (\S+)\}, \{4, \S+\}, seed = 3 \} -- of the smoke\n")
        live.click_on("lumps.scale_2", button=3)
        live.widget("lumps.scale_2/copy name")
        live.keys("Escape")
        two = self.settled(live)
        self.assertGreater(difference(first, two), 8)
        live.click_on("layer 1/remove")
        live.click_on("cancel")
        live.click_on("layer 2/duplicate")
        live.click_on("write")
        live.expect("live: took over")
        self.assertEqual(len(re.findall(r"\{4, ", self.read("puff.lua"))), 2)
        for _ in range(2):
            live.keys("ctrl+z")
            live.expect("live: undid written: layers of lumps")
            live.expect("live: took over")
        self.assertEqual(self.read("puff.lua"), lumpy)
        live.widget("lumps.strength_1/reset")  # it is set, as before
        live.keys("ctrl+z")
        live.expect("live: undid lumps.strength_1")
        self.looks_like(live, first, "the first picture")
        live.quit()

    def test_saved_presets(self):
        self.write("puff.presets/mine.lua", "return { thickness = 12 }")
        live = self.live("--set", "size=2")
        live.expect("live: shown")
        self.slide(live, "thickness", 0.2, 0.75)
        live.keys("ctrl+s")
        live.expect("live: wrote preset preset-1")
        saved = self.read("puff.presets/preset-1.lua")
        self.assertIn("thickness", saved)
        live.click_on("preset name")
        live.type("mine")
        live.click(*live.middle("preset save"))
        live.click(*live.middle("preset save"))  # yes, replace it
        live.expect("live: wrote puff.presets/mine.lua")
        self.assertNotEqual(self.read("puff.presets/mine.lua"), "return { thickness = 12 }")
        live.keys("Escape")  # typed no more
        live.keys("ctrl+z")
        live.expect("live: undid saved preset mine")
        self.assertEqual(self.read("puff.presets/mine.lua"), "return { thickness = 12 }")
        live.keys("ctrl+z")
        live.expect("live: undid saved preset preset-1")
        self.assertFalse(os.path.exists(self.path("puff.presets/preset-1.lua")))
        live.keys("ctrl+y")
        live.expect("live: redid saved preset preset-1")
        self.assertEqual(self.read("puff.presets/preset-1.lua"), saved)
        self.write("puff.presets/preset-1.lua", "return { size = 3 }")  # by somebody else
        live.keys("ctrl+z")
        live.expect("live: notice: .*preset-1.lua has changed meanwhile; it stays as it is")
        self.assertEqual(self.read("puff.presets/preset-1.lua"), "return { size = 3 }")
        live.quit()

    def taken(self, live):
        """Waits until the window has taken all input: it does so in order, and this is a key of its own."""
        mark = live.mark()
        live.keys("l")
        live.expect("live: notice: St(arts again|ops) at the end", mark)

    def undo_all(self, live):
        """Returns how many steps there were; none is lost, since each is awaited."""
        for count in range(2 * ACTIONS):
            mark = live.mark()
            live.keys("ctrl+z")
            if "Nothing" in live.expect("live: undid |live: notice: Nothing to undo", mark).group(0):
                return count
        return self.fail("there is no end to what was done")

    def test_many_at_random(self):
        """Whatever was done in whatever order: undone to the end, all is as it was."""
        self.write("puff.presets/thick.lua", "return { thickness = 12, glow = false }")
        live = self.live()
        live.expect("live: shown")
        first, controls = self.picture(live), set(live.widgets())
        chance = random.Random(7)
        names = ["thickness", "size", "steps", "fire/stops"]
        for _ in range(ACTIONS):
            kind = chance.choice(["slide", "slide", "turn", "wheel", "glow", "preset", "undo", "undo", "redo"])
            if kind == "slide":
                self.slide(live, chance.choice(names), chance.random() * 0.9 + 0.05, chance.random() * 0.9 + 0.05)
            elif kind == "turn":
                self.turn(live, chance.uniform(-90, 90), chance.uniform(-90, 90))
            elif kind == "wheel":
                live.click(*live.middle(VIEW), button=chance.choice([4, 5]))
            elif kind == "glow":
                live.click_on("glow")
            elif kind == "preset":
                live.click_on("preset")
                live.click_on("thick")
            else:
                live.keys("ctrl+z" if kind == "undo" else "ctrl+y")
            self.taken(live)
        self.assertGreater(sum("live: set " in line for line in live.log), ACTIONS / 3)
        self.assertGreater(sum("live: undid " in line for line in live.log), ACTIONS / 20)
        self.assertGreater(self.undo_all(live), ACTIONS / 20)
        live.wait_until(lambda: not [name for name in live.widgets() if re.search("/reset$", name)],
                        "the script's values")
        self.looks_like(live, first, "the first picture")
        self.assertEqual({name for name in set(live.widgets()) ^ controls if not re.match(CHOSEN, name)}, set())
        live.quit()


require_tools()
main()
