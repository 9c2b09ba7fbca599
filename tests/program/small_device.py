"""A device with small limits (ROIL_SMALL_DEVICE): every shipped effect draws what it draws otherwise.
Which variants of kernels are taken there, a few effects show; with ROIL_LONG_TESTS=1 all are drawn.
`small_device.py 2/3` draws the second third of them only, as ctest does."""
import os
import re
import sys
from concurrent.futures import ThreadPoolExecutor

from lib.program import SOURCE, Case, main

SMALL_DEVICE = {"ROIL_SMALL_DEVICE": "1"}
EFFECTS = os.path.join(SOURCE, "effects")
LATEST, SIMULATED = 8, 2  # frames: later ones take long, with air that is simulated much longer
# Between them they have every kernel that has a variant: ranges of bricks, groups of `lighting`, `bloom`,
# `slices` and of particles that are sorted, and instances that are drawn, into shadow maps too.
DRAWN = {"containers.lua", "deferred_lights.lua", "forest_fire.lua", "layered_explosion.lua", "paper.lua",
         "sparks.lua", "templates.lua", "toon_fire.lua"}
LONG = os.environ.get("ROIL_LONG_TESTS") == "1"
# Results of another order of sums, seen in pictures of 8 bits.
MOST_FLIP = "0.005"
# The grids of its pressure end at another size, so that its flow differs a little in each step: 0.0072 (54 dB) was seen.
OWN_FLIP = {"log_fire.lua": "0.01"}


PART, PARTS = 1, 1


def list_effects():
    return sorted(name for name in os.listdir(EFFECTS) if name.endswith(".lua"))


def latest_frame(name):
    with open(os.path.join(EFFECTS, name), encoding="utf-8") as script:
        return SIMULATED if re.search(r"\b(lbm|pyro|slices) *\{", script.read()) else LATEST


def find_pictures():
    """Of each effect: a frame, and the settings of its first golden picture."""
    found = {}
    with open(os.path.join(SOURCE, "tests/golden/pictures.txt"), encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if words and words[0][0] != "#":
                found.setdefault(words[1], (min(int(words[2]), latest_frame(words[1])), words[3:]))
    return found


class SmallDevice(Case):
    def draw(self, name, frame, settings, output, environment=None):
        return self.run_program("render", os.path.join(EFFECTS, name), "--frames", str(frame), "--size",
                                "64x36", "-o", output, *settings, environment=environment)

    def compare(self, name, frame, settings):
        small, usual = f"{name}.small.png", f"{name}.png"
        for output, environment in ((small, SMALL_DEVICE), (usual, {"ROIL_VALIDATE": "0"})):
            done = self.draw(name, frame, settings, output, environment)
            if done.returncode != 0:
                return f"{name}: {done.stderr}"
        done = self.run_program("compare", usual, small, "--max-flip", OWN_FLIP.get(name, MOST_FLIP))
        return None if done.returncode == 0 else f"{name}: {done.stdout}{done.stderr}"

    def setUp(self):
        super().setUp()
        if PART > 1 and "draws_the_same" not in self.id():
            self.skipTest("the first part does so")

    def test_every_effect_is_checked(self):
        good = list_effects()
        told = self.succeeds("check", *(os.path.join(EFFECTS, name) for name in good), environment=SMALL_DEVICE)
        self.assertEqual(told.count(": good\n"), len(good), told)

    def test_every_effect_draws_the_same(self):
        pictures = find_pictures()
        drawn = list_effects()
        self.assertEqual([name for name in drawn if name not in pictures], [])
        self.assertLessEqual(DRAWN, {*drawn})
        drawn = [name for name in drawn if LONG or name in DRAWN][PART - 1::PARTS]
        self.assertTrue(drawn)
        with ThreadPoolExecutor(2) as pool:
            found = pool.map(lambda name: self.compare(name, *pictures[name]), drawn)
        self.assertEqual([wrong for wrong in found if wrong], [])

    def test_a_shader_of_a_user_is_refused(self):
        self.write("wide.comp", "writeonly uniform image2D color; //= output rgba16f : what is drawn\n"
                                "layout(local_size_x = 32, local_size_y = 16) in;\n"
                                "void main() { imageStore(color, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }\n")
        effect = ('local fx = effect { name = "wide" }\n'
                  'fx.output = shader { "wide.comp" }.color\nreturn fx\n')
        self.write("effect.lua", effect)
        self.succeeds("check", "effect.lua")
        self.fails(1, ["effect.lua:2: ", "has 512 threads in a work group; the device allows 256",
                       "(maxComputeWorkGroupInvocations)"], "check", "effect.lua", environment=SMALL_DEVICE)


if __name__ == "__main__":
    if len(sys.argv) > 1 and "/" in sys.argv[1]:
        PART, PARTS = map(int, sys.argv.pop(1).split("/"))
    main()
