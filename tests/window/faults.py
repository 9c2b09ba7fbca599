"""What a shader does to the driver must not take the window with it."""
import os
import signal
import subprocess
import time

from lib.window import PATIENCE, Case, main, require_tools

EFFECT = """
local fx = effect { name = "puff", fps = 24, frames = 48 }
local thickness = param { "thickness", 4, min = 0, max = 20 }
local ball = march { density = sphere { radius = 1 } * thickness }
fx.camera = orbit { distance = 5 }
fx.output = final { %s }.color
return fx
"""
SINES = "sum = sin(sum); " * 64
ENDLESS = f"""// Takes a quarter of an hour: lavapipe leaves a loop after 65,535 turns.
uniform float zero; //= 0 [0, 1] : no compiler knows it
uniform sampler2D input_; //= input : the picture
uniform writeonly image2D color; //= output rgba16f : the picture
void main() {{
    float sum = 0.0;
    for (float a = 0.0; a < 60000.0 + zero; a += 1.0) {{ sum += a; {SINES} }}
    imageStore(color, ivec2(gl_GlobalInvocationID.xy), vec4(sum));
}}
"""


class Faults(Case):
    def test_a_crash_starts_the_window_anew(self):
        live = self.live("--set", "thickness=9", effect=EFFECT % "ball")
        os.kill(live.process.pid, signal.SIGSEGV)
        live.expect("roil: the process crashed and restarts")
        live.expect("live: the process crashed while it drew this")
        live.expect("live: took over")  # the file as it was when it crashed
        with open(f"/proc/{live.process.pid}/cmdline", encoding="utf-8") as f:
            self.assertIn("thickness=9", f.read())
        mark = live.mark()
        self.write("puff.lua", EFFECT % "ball" + "-- mended\n")
        live.expect("live: drew frame", mark)
        self.write("puff.lua", "broken(")
        live.expect("live: .*puff.lua:", mark)
        live.quit()

    def test_a_second_crash_while_held_ends_it(self):
        live = self.live(effect=EFFECT % "ball")
        os.kill(live.process.pid, signal.SIGSEGV)
        live.expect("live: the process crashed while it drew this")
        live.expect("live: shown")
        os.kill(live.process.pid, signal.SIGSEGV)
        live.process.wait(PATIENCE)
        self.assertEqual(live.process.returncode, -signal.SIGSEGV)

    def hang(self):
        live = self.live(effect=EFFECT % "ball")
        self.write("endless.comp", ENDLESS)
        self.write("puff.lua", EFFECT % 'shader { "endless.comp", input = ball }')
        live.wait_until(lambda: "busy for" in self.title(live), "a title that says so")
        return live

    @staticmethod
    def title(live):
        return subprocess.run(["xdotool", "getwindowname", live.window()], check=False,
                              env=live.case.environment, stdout=subprocess.PIPE, text=True,
                              timeout=PATIENCE).stdout

    def test_a_frame_without_end_can_be_given_up(self):
        live = self.hang()  # for twice as long as the frame before it, Escape waits for it
        live.wait_until(lambda: "given up while it worked" in live.text() or live.keys("Escape"), "an end")
        live.expect("it was given up while it worked.*the program restarts")
        live.expect("live: took over")  # the file as it was
        mark = live.mark()
        self.write("puff.lua", EFFECT % "ball")
        live.expect("live: drew frame", mark)
        live.quit()

    def test_a_window_whose_frame_does_not_end_can_be_closed(self):
        live = self.hang()
        live.keys("ctrl+q")
        live.process.wait(PATIENCE)
        self.assertEqual(live.process.returncode, 0, live.text())

    def test_a_load_that_hangs_does_not_keep_a_window_open(self):
        live = self.live(effect=EFFECT % "ball")
        found = subprocess.run(["pgrep", "-P", str(live.process.pid), "roil-reader"], check=True, timeout=PATIENCE,
                               stdout=subprocess.PIPE, text=True)
        reader = int(found.stdout)
        os.kill(reader, signal.SIGSTOP)  # as a file system or a driver that hangs
        self.addCleanup(os.kill, reader, signal.SIGCONT)
        mark = live.mark()
        self.write("new.comp", ENDLESS.replace("Takes", str(time.time_ns())))
        self.write("puff.lua", "print('busy')\n" + EFFECT % 'shader { "new.comp", input = ball }')
        live.expect("busy", mark)
        live.quit()
        live.expect("a load hangs and was abandoned", mark)

    def test_a_long_warm_up_does_not_keep_a_window_busy(self):
        live = self.live(effect="""
local fx = effect { name = "air" }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, warm_up = 86400 }
air:source { shape = sphere { radius = 0.3 }, density = 1 }
fx.output = final { march { density = air.density, steps = 4 } }.color
return fx
""")
        mark = live.mark()
        self.write("puff.lua", EFFECT % "ball")
        live.expect("live: took over", mark)
        live.quit()

if __name__ == "__main__":
    require_tools()
    main()
