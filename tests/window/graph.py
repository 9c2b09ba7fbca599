"""The graph: passes with times and pictures, and where clicks on them lead."""
import os

from lib.window import PUFF, Case, main, require_tools


class Graph(Case):
    def graph(self, **environment):
        live = self.live(environment=environment)
        live.expect("live: shown")
        live.keys("n")
        live.widget("march/name")
        return live

    def test_passes_with_times_and_pictures(self):
        live = self.graph()
        march, final = live.widget("march/name"), live.widget("final/name")
        self.assertGreater(final[0], march[2])  # what reads stands to the right
        live.widget("march/time")
        left, _, right, bottom = march
        live.wait_until(lambda: live.screenshot().crop(left, bottom + 24, right, bottom + 100).colors() > 40, "a picture of the march")
        left, _, right, bottom = final
        live.wait_until(lambda: live.screenshot().crop(left, bottom + 24, right, bottom + 100).colors() > 40, "the final picture")
        left, _, right, bottom = live.widget("final/time")
        seen = live.screenshot().crop(left + 10, bottom + 8, right - 10, bottom + 100)
        bright = [(x, y) for y in range(seen.height) for x in range(seen.width) if max(seen.pixel(x, y)) > 64]
        wide, high = (max(c) - min(c) for c in zip(*bright))
        self.assertGreater(wide, 15)
        self.assertLess(abs(wide - high), 2, f"the ball is round: {wide} x {high}")
        live.keys("n")
        live.wait_until(lambda: "march/name" not in live.widgets(), "the picture alone")
        live.quit()

    def test_clicks_lead_to_the_panel_and_the_inspector(self):
        live = self.graph()
        live.click_on("march/name")
        live.expect(r"live: found march\.")
        live.widget("march.shadow_steps")
        self.assertNotIn("thickness", live.widgets())
        live.click_on("march/march.color")
        live.widget("inspected")
        live.quit()

    def test_a_line_opens_the_editor(self):
        editor, told = self.path("editor.sh"), self.path("told")
        with open(editor, "w", encoding="utf-8") as f:
            f.write(f'#!/bin/sh\necho "$@" > "{told}~"\nmv "{told}~" "{told}"\n')
        os.chmod(editor, 0o700)
        line = next(i for i, text in enumerate(PUFF.splitlines(), 1) if "march {" in text)
        live = self.graph(ROIL_EDITOR=editor + " --at %l:%f")
        live.click_on("march/line")
        live.wait_until(lambda: os.path.exists(told), "the editor")
        self.assertEqual(self.read("told").strip(), f"--at {line}:puff.lua")
        live.quit()

    def test_without_an_editor_it_says_how_to_set_one(self):
        live = self.graph(ROIL_EDITOR="", VISUAL="")
        live.click_on("march/line")
        live.expect(r"live: notice: puff.lua:\d+; ROIL_EDITOR names the editor")
        live.quit()


require_tools()
main()
