"""Who sees little, or has a small or a large display: contrast, sizes, keys, and nothing over each other."""
import itertools
import re

from lib.window import Case, main, require_tools

# What holds others, or is drawn over others.
AROUND = re.compile(r"^(panel|presets|view|search|timeline|.*/(reset|ramp|plot|stops|curve|sheet)|stop \d|key \d|focus|preset save)$")


class Look(Case):
    def opened(self, *args, **options):
        live = self.live(*args, **options)
        live.expect("live: shown")
        return live

    def rows(self, live):
        left = live.widget("panel")[0] if "panel" in live.widgets() else live.widget("thickness")[0]
        foot = live.widget("preset")[1]  # what has been scrolled below it is not seen
        own = ("preset", "preset name", "save", "reset all", "write into the file")
        return {name: at for name, at in live.widgets().items()
                if at[0] >= left - 1 and not AROUND.match(name) and (name in own or at[3] <= foot)}

    def check_places(self, live, width):
        rows = self.rows(live)
        self.assertGreater(len(rows), 8)
        for name, at in rows.items():
            self.assertLessEqual(at[2], width, f"{name} goes beyond the window: {at}")
        for (a, p), (b, q) in itertools.combinations(rows.items(), 2):
            apart = p[2] <= q[0] + 1 or q[2] <= p[0] + 1 or p[3] <= q[1] + 1 or q[3] <= p[1] + 1
            inside = a.startswith(b) or b.startswith(a)
            self.assertTrue(apart or inside, f"{a} {p} lies over {b} {q}")

    def test_high_contrast_stays(self):
        live = self.opened()
        left, _, right, bottom = live.widget("save")
        at = (right - 3, bottom + 4)  # the panel's ground
        grey = live.screenshot().pixel(*at)
        self.assertGreater(min(grey), 20)
        live.keys("F2")
        live.wait_until(lambda: live.screenshot().pixel(*at) == (0, 0, 0), "a black ground")
        row = live.widget("thickness")
        live.wait_until(lambda: max(live.screenshot().crop(*row).mean()) > 0 and
                        any(b"\xff\xff\xff" in line for line in live.screenshot().crop(*row).rows), "white letters")
        live.quit()
        live = self.opened()
        live.wait_until(lambda: live.screenshot().pixel(*at) == (0, 0, 0), "a black ground again")
        live.quit()

    def test_sizes(self):
        live = self.opened()
        before = live.widget("thickness")
        live.keys("ctrl+equal", "ctrl+equal", "ctrl+equal")
        live.expect("live: notice: Interface at 130 %")
        live.wait_until(lambda: abs((live.widget("thickness")[3] - live.widget("thickness")[1]) -
                                    1.3 * (before[3] - before[1])) < 1.5, "larger rows")
        self.check_places(live, 1200)
        live.keys(*["ctrl+minus"] * 3)
        live.expect("live: notice: Interface at 100 %")
        live.wait_until(lambda: live.widget("thickness") == before, "the rows as before")
        live.quit()

    def test_nothing_lies_over_another(self):
        live = self.opened("--size", "1280x720")
        live.widget("thickness")
        self.check_places(live, 1280)
        live.quit()

    def test_what_opens_fits_small_windows_and_large_letters(self):
        live = self.opened("--size", "1280x720")
        live.keys("F1")
        _, top, right, bottom = live.widget("keys")
        self.assertTrue(top >= 0 and right <= 1280 and bottom <= 720, "all keys are seen")
        live.keys("F1", *["ctrl+equal"] * 10)
        live.expect("live: notice: Interface at 200 %")
        live.keys("F1")
        live.wait_until(lambda: live.widgets().get("keys", [0, 0, 0, 0])[3] > 720, "one column, to be scrolled")
        self.assertLessEqual(live.widgets()["keys"][2], 1280)
        live.keys("F1", "p")
        left, _, right, _ = live.widget("performance")
        self.assertGreaterEqual(right - left, 2 * 420)  # what its texts need
        self.assertLessEqual(live.widget("time")[2], live.widget("view")[2])
        live.quit()

    def test_by_keys_alone(self):
        live = self.opened()
        live.keys("F6")
        live.expect("live: notice: Arrows, Tab and Enter")
        live.keys("Tab")
        live.widget("thickness/typed")
        live.type("9")
        live.keys("Tab")  # to the next number
        live.expect("live: set thickness = 9$")
        live.widget("steps/typed")
        live.type("30")
        live.keys("Return")
        live.expect("live: set steps = 30$")
        live.wait_until(lambda: "focus" in live.widgets() or live.keys("Down"), "a frame around what is chosen")
        live.keys("Escape")
        live.wait_until(lambda: "focus" not in live.widgets(), "keys that are the window's")
        live.keys("n")
        live.widget("march/name")
        live.quit()


require_tools()
main()
