"""The page on which one chooses an effect, and what can be opened there."""
import ctypes
import json
import os
import shutil
import struct
import subprocess

from lib.window import PATIENCE, PUFF, SOURCE, Case, Live, main, require_tools

BALL = PUFF.replace('name = "puff"', 'name = "ball"')


def drop(display, window, path):
    """What a file manager does that lets go of a file over the window: XDND, version 5, as a program of its own."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
    x.XInternAtom.restype = ctypes.c_ulong
    x.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
    x.XDefaultRootWindow.restype = ctypes.c_ulong
    x.XCreateSimpleWindow.argtypes = [ctypes.c_void_p, ctypes.c_ulong] + [ctypes.c_int] * 2 + [ctypes.c_uint] * 3 + [ctypes.c_ulong] * 2
    x.XCreateSimpleWindow.restype = ctypes.c_ulong
    x.XSetSelectionOwner.argtypes = [ctypes.c_void_p] + [ctypes.c_ulong] * 3
    x.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    x.XNextEvent.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    x.XFlush.argtypes = x.XCloseDisplay.argtypes = [ctypes.c_void_p]
    x.XChangeProperty.argtypes = [ctypes.c_void_p] + [ctypes.c_ulong] * 3 + [ctypes.c_int] * 2 + [ctypes.c_char_p, ctypes.c_int]
    d = x.XOpenDisplay(display.encode())

    def atom(name):
        return x.XInternAtom(d, name.encode(), 0)

    mine = x.XCreateSimpleWindow(d, x.XDefaultRootWindow(d), 0, 0, 1, 1, 0, 0, 0)
    uris = ("file://" + path + "\r\n").encode()

    def tell(name, *longs):
        event = struct.pack("iQiQQQi4x5q", 33, 0, 1, d, window, atom(name), 32, *(list(longs) + [0] * 5)[:5])
        x.XSendEvent(d, window, 0, 0, ctypes.create_string_buffer(event, 192))
        x.XFlush(d)

    def next_event():
        buffer = ctypes.create_string_buffer(192)
        x.XNextEvent(d, buffer)
        return struct.unpack_from("i", buffer)[0], buffer

    x.XSetSelectionOwner(d, atom("XdndSelection"), mine, 0)
    tell("XdndEnter", mine, 5 << 24, atom("text/uri-list"))
    tell("XdndPosition", mine, 0, (200 << 16) | 200, 0, atom("XdndActionCopy"))
    while True:
        kind, event = next_event()
        if kind == 33:  # it answers: XdndStatus, and at last XdndFinished
            said = struct.unpack_from("Q", event, 40)[0]
            if said == atom("XdndStatus"):
                tell("XdndDrop", mine, 0, 0)
            elif said == atom("XdndFinished"):
                break
        elif kind == 30:  # it asks for the selection
            requestor, selection, target, prop, when = struct.unpack_from("5Q", event, 40)
            x.XChangeProperty(d, requestor, prop, target, 8, 0, uris, len(uris))
            answer = struct.pack("iQiQ5Q", 31, 0, 1, d, requestor, selection, target, prop, when)
            x.XSendEvent(d, requestor, 0, 0, ctypes.create_string_buffer(answer, 192))
            x.XFlush(d)
    x.XCloseDisplay(d)


class Start(Case):
    def start(self, *args):
        live = Live(self, "--size", "1200x720", *args)
        self.addCleanup(live.kill)
        live.expect("live: start page")
        live.tool("windowfocus", "--sync", live.window())
        return live

    def begins(self, live):
        live.expect("live: first frame")
        live.tool("windowfocus", "--sync", live.window())

    def test_an_effect_of_the_folder_then_among_the_recent(self):
        self.write("puff.lua", PUFF)
        self.write("ball.lua", BALL)
        self.write("module.lua", "return {}")
        live = self.start()
        live.widget("shipped with roil/explosion")
        cards = live.widgets()
        self.assertIn("in this folder/ball", cards)
        self.assertNotIn("in this folder/module", cards)
        self.assertFalse([name for name in cards if name.startswith("recent")])
        live.click_on("in this folder/puff")
        live.expect(r"live: chose puff.lua")
        self.begins(live)
        live.keys("ctrl+o")  # back to the page, on which it now has a picture
        live.expect("live: start page")
        live.tool("windowfocus", "--sync", live.window())
        left, top, right, bottom = live.widget("recent/puff")
        live.tool("mousemove", 5, 5)
        live.wait_until(lambda: live.screenshot().crop(left, top, right, bottom - 30).colors() > 100, "its picture")
        live.click_on("recent/puff")
        self.begins(live)
        live.quit()

    def test_contrast_and_size_are_kept(self):
        live = self.start()
        high = live.widget("open")
        live.wait_until(lambda: min(live.screenshot().pixel(3, 500)) > 20, "a grey ground")
        live.keys("F2", "ctrl+equal", "ctrl+equal")
        live.wait_until(lambda: live.screenshot().pixel(3, 500) == (0, 0, 0), "a black ground")
        live.wait_until(lambda: live.widget("open")[3] - live.widget("open")[1] > high[3] - high[1] + 1, "a larger button")
        live.keys("Escape")
        live.process.wait(PATIENCE)
        with open(self.path("state/session.json"), encoding="utf-8") as f:
            kept = json.load(f)
        self.assertTrue(kept["contrast"])
        self.assertAlmostEqual(kept["scale"], 1.2, 3)

    def test_new_from_a_template(self):
        live = self.start("--size", "800x500")  # quick to draw
        live.widget("simulated smoke")
        live.click_on("name")
        live.type("my_burst")
        live.click_on("a burst of noise, quick to draw")
        live.expect("live: chose my_burst.lua")
        live.expect("live: took over")
        live.tool("windowfocus", "--sync", live.window())
        with open(os.path.join(SOURCE, "scripts/start/burst.lua"), encoding="utf-8") as f:
            self.assertEqual(self.read("my_burst.lua"), f.read())
        live.keys("ctrl+o")
        live.expect("live: start page")
        live.tool("windowfocus", "--sync", live.window())
        live.widget("simulated smoke")
        live.click_on("name")
        live.type("my_burst")
        live.click_on("a burst of noise, quick to draw")
        live.expect("live: refused: there is a my_burst.lua already")
        live.click_on("a campfire, with its logs")  # refused too: the name is still there
        live.expect("live: refused: there is a my_burst.lua already")
        live.keys("Escape")
        live.process.wait(60)
        self.assertEqual(live.process.returncode, 0)

    def test_by_path_a_picture_with_its_recipe(self):
        self.write("puff.lua", PUFF)
        subprocess.run([os.path.join(os.environ.get("ROIL_BINARY_DIR", "."), "roil"), "render", "puff.lua", "--frames", "7",
                        "-s", "64x48", "--set", "thickness=9", "-o", "shot.png"], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        live = self.start("--paused")
        live.click_on("path")
        live.type("shot.pgn")
        live.keys("Return")
        live.expect("live: refused: shot.pgn")
        live.keys("Escape")
        live.process.wait(60)
        live = self.start("--paused")
        live.click_on("path")
        live.type("shot.png")
        live.keys("Return")
        live.expect("live: chose puff.lua")
        self.begins(live)
        live.widget("thickness/reset")  # as the recipe says
        live.expect(r"live: drew frame 7\b", 0)
        live.quit()

    def test_a_sequence_is_dropped(self):
        folder = self.path("volumes")
        os.makedirs(folder)
        for i in (10, 11, 12):
            shutil.copy(os.path.join(SOURCE, f"effects/data/explosion-32/{i:04d}.vdb"), os.path.join(folder, f"cloud_{i}.vdb"))
        live = self.start("--paused")
        drop(self.display.name, int(live.window()), os.path.join(folder, "cloud_11.vdb"))
        live.expect("live: chose .*/volumes/cloud.lua")
        self.begins(live)
        text = self.read("volumes/cloud.lua")
        self.assertIn('vdb { "cloud_*.vdb", fps = 24 }', text)
        self.assertIn('name = "cloud", fps = 24, frames = 3', text)
        self.assertIn('volume["density"]', text)
        drop(self.display.name, int(live.window()), os.path.join(folder, "cloud_12.vdb"))  # the same, not another
        self.begins(live)
        self.assertEqual([name for name in os.listdir(folder) if name.endswith(".lua")], ["cloud.lua"])
        live.quit()


require_tools()
main()
