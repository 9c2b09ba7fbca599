"""What the window looks like, beside golden pictures of it: panel, help, messages, high density.
ROIL_UPDATE=1 takes new ones; look at them before they are kept."""
import os
import subprocess

from lib.window import BINARY, PUFF, RISE, SOURCE, Case, Display, main, require_tools

GOLDEN = os.path.join(SOURCE, "tests/window/golden")
COMPARE = os.path.join(BINARY, "golden_compare")


class Pictures(Case):
    def check(self, live, name):
        """The window comes to look like the golden picture: when all is drawn cannot be told from outside."""
        actual, expected = self.path(name), os.path.join(GOLDEN, name)
        difference = os.path.join(BINARY, f"window-{name}")
        last = []

        def steady():
            now = live.screenshot()
            last.append(now)
            return len(last) > 1 and last[-2].rows == now.rows

        def equal():
            live.screenshot().save(actual)
            done = subprocess.run([COMPARE, expected, actual, difference], check=False, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
            return done.returncode == 0

        if os.environ.get("ROIL_UPDATE") == "1":
            live.wait_until(steady, "a window that stands still")
            last[-1].save(expected)
        else:
            live.wait_until(equal, f"the picture {name} (see {difference})")

    def start(self, *args, **options):
        live = self.live("--frame", "20", *args, **options)
        live.expect("live: shown")
        live.tool("mousemove", 1, 1)  # over nothing that shows it
        return live

    def test_panel_message_and_help(self):
        live = self.start()
        self.check(live, "panel.png")
        self.write("puff.lua", PUFF.replace("thickness, emission", "thicknes, emission"))
        live.widget("message")
        self.check(live, "message.png")
        self.write("puff.lua", PUFF)
        live.wait_until(lambda: "message" not in live.widgets(), "the end of the message")
        live.keys("F1")
        live.widget("help")
        self.check(live, "help.png")
        live.quit()

    def test_inspector(self):
        live = self.start()
        live.keys("i")
        live.widget("inspector")
        self.check(live, "inspector.png")
        live.quit()

    def test_slices(self):
        live = self.start(effect=RISE)
        live.keys("s")
        live.click_on("slices/view")
        live.click_on("slices/velocity")
        live.click_on("slices/put")
        live.click_on("slices/jet.exr")
        live.tool("mousemove", 1, 1)
        self.check(live, "slices.png")
        live.quit()


class HighDensity(Pictures):
    @classmethod
    def setUpClass(cls):
        cls.display = Display(density=192)
        cls.addClassCleanup(cls.display.close)

    test_panel_message_and_help = test_inspector = test_slices = None

    def test_panel(self):
        live = self.start()
        self.check(live, "dense.png")
        live.quit()


require_tools()
main()
