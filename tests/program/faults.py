"""Every call of Vulkan that can fail, and every allocation, fails once, or fails from then on, while the
program loads, draws, reloads, exports and keeps a checkpoint. Then it either does its work all the same, to
the same files, or ends with status 1 and one message; it is never killed, never hangs, never misuses Vulkan,
and leaves neither a draft nor a temporary folder behind.
`../fault/fault.c` makes the calls fail.

    faults.py                                            a sample, in each run of the tests
    faults.py 2/3                                        the second third of the scenarios, as ctest does
    faults.py --all [--step 1] [--only draw/vulkan]      each call of each scenario, or each STEP-th
    faults.py --all --paths [--jobs 2]                   the first of each path
    faults.py --case 'draw/vulkan 120 once'              one of them

A path is the functions that lead to a call: eight in roil, four in the processes that it starts, where most of
what is allocated is a compiler's. With --paths that leaves one allocation of 30; each call of Vulkan is made to
fail all the same.
"""
import argparse
import concurrent.futures
import os
import queue
import random
import shutil
import struct
import subprocess
import sys
import tempfile

from lib.program import BINARY, GROUND, PROGRAM, PUFF, Case, main

LIBRARY = os.path.join(BINARY, "libfault.so")
LIBRARIES = "liblua,libpng,libjansson"  # whose allocations fail beside the program's own
LIMIT = 120  # seconds of a run
SAMPLE = 2  # cases of each scenario, class and way in a run of the tests
DEPTHS = "8,4"
REPORT = struct.Struct("<6Q64s")  # as in fault.c, and before each path
PATH = struct.Struct("<3Q")
SIZE = ["--size", "48x27"]

AIR = """
local fx = effect { name = "air", fps = 60, frames = 2 }
fx.camera = orbit { target = {0, 0, 0.8}, distance = 4 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6 }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1, temperature = 2 }
fx.output = final { march { density = air.density * 30, steps = 8 } }.color
return fx
"""

# One shader, since "load" and "reload" compile all that there are.
SPOT = """
local fx = effect { name = "spot" }
fx.camera = orbit { distance = 4 }
local ball = sphere { position = {0.5, 0.3, 0}, radius = 0.2, falloff = 0.1 } * perlin { frequency = 2 }
fx.output = shader { "spot.comp", heat = ball, level = 0.4 }.color
return fx
"""

SHADER = """// A field in a plane.
#include "fields.glsl"
//@ field float heat : seen from above
uniform float level; //= 1 [0, 10] : how bright
writeonly uniform image2D color; //= output rgba8 : picture
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec3 p = vec3(vec2(pixel) / vec2(imageSize(color)), 0.0);
    imageStore(color, pixel, vec4(field_heat(p) * level, 0.0, 0.0, 1.0));
}
"""

SWEEP = """
return sweep { name = "edits", effect = "spot.lua", measure = "reload", size = {48, 27}, repeats = 1,
               axes = { axis { "edit", { name = "level", edit = {"0.4", "0.5"} } } } }
"""

# By name: the command, and whether what it leaves is the same each time.
SCENARIOS = {
    "load": (["check", "spot.lua"], True),
    "draw": (["render", "puff.lua", *SIZE, "--frames", "1-2", "-o", "drawn/%d.png"], True),
    "save": (["render", "air.lua", *SIZE, "--frames", "1", "-o", "first.png", "--checkpoint", "new.state"],
             True),
    "go on": (["render", "air.lua", *SIZE, "--restore", "old.state", "--frames", "2", "-o", "second.png"],
              True),
    "export": (["export", "vdb", "air.lua", "--frames", "1", "-o", "volumes/%d.vdb"], False),
    "reload": (["bench", "sweep.lua", "-o", "measured"], False),
}
CLASSES = ("vulkan", "memory")
# Went wrong once; in each run of the tests.
FOUND = [("draw", "vulkan", "vkWaitSemaphores", ["always"])]


class Stage:
    """A scratch folder with the files of the scenarios. Compiled shaders are kept beside it, by scenario, so that a
    run is short; "load" begins without."""

    def __init__(self):
        self.root = tempfile.mkdtemp(prefix="roil-faults-")
        self.folder = os.path.join(self.root, "work")
        for name in "work", "tmp":
            os.mkdir(os.path.join(self.root, name))
        self.inputs = {"puff.lua": PUFF, "ground.obj": GROUND, "air.lua": AIR, "spot.lua": SPOT, "spot.comp": SHADER,
                       "sweep.lua": SWEEP}
        for name, text in self.inputs.items():
            with open(self.path(name), "w", encoding="utf-8") as f:
                f.write(text)
        self.expected, self.counts, self.ways = {}, {}, {}
        self.start("save")
        os.rename(self.path("new.state"), self.path("old.state"))
        self.clear()

    def path(self, name):
        return os.path.join(self.folder, name)

    def cache(self, name):
        return os.path.join(self.root, "cache", name)

    def start(self, name, fault=None):
        environment = {**os.environ, "LD_PRELOAD": LIBRARY, "TMPDIR": os.path.join(self.root, "tmp"),
                       "ROIL_CACHE_DIR": self.cache(name), "ROIL_FAULT_LIBRARIES": LIBRARIES,
                       "ROIL_FAULT_FILE": os.path.join(self.root, "counts")}
        if not fault or "@" in fault:
            environment["ROIL_FAULT_DEPTH"] = DEPTHS
        if fault:
            environment["ROIL_FAULT"] = fault
        return subprocess.run([PROGRAM, *SCENARIOS[name][0]], cwd=self.folder, env=environment, timeout=LIMIT, check=False,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              errors="replace")

    def told(self):
        """What the library wrote: calls by class, how many failed, how many came after, and which was the first."""
        with open(os.path.join(self.root, "counts"), "rb") as f:
            vulkan, memory, failed, after, place, exited, name = REPORT.unpack(f.read(REPORT.size))
        return {"vulkan": vulkan, "memory": memory, "failed": failed, "after": after, "exited": exited,
                "first": f"{name.split(bytes(1))[0].decode()} called at {place:#x}"}

    def paths(self):
        """By class the paths of all calls, in the order of their first calls."""
        found = {kind: [] for kind in CLASSES}
        with open(os.path.join(self.root, "counts"), "rb") as f:
            for path, kind, number in PATH.iter_unpack(f.read()[REPORT.size:]):
                if path:
                    found[CLASSES[kind]].append((number, f"@{path:x}"))
        return {kind: [path for _, path in sorted(all_paths)] for kind, all_paths in found.items()}

    def files(self):
        """Contents by path of all that is here, drafts in the folder of temporary files too, and was not put here."""
        found = {}
        for top in self.folder, os.path.join(self.root, "tmp"):
            for folder, _, names in os.walk(top):
                for name in names:
                    path = os.path.relpath(os.path.join(folder, name), self.folder)
                    # The validation layers keep a file of their own in TMPDIR where the user has no folder of caches.
                    if path not in self.inputs and path != "old.state" and not name.startswith("shader_validation_cache"):
                        with open(os.path.join(folder, name), "rb") as f:
                            found[path] = f.read()
        return found

    def clear(self):
        for path in self.files():
            os.unlink(self.path(path))
        for name in os.listdir(self.folder):
            if os.path.isdir(self.path(name)):
                shutil.rmtree(self.path(name))
        with open(os.path.join(self.root, "counts"), "wb"):
            pass

    def rehearse(self, name):
        """Runs a scenario as it is, twice: the second finds the shaders compiled."""
        for _ in range(2):
            self.prepare(name)
            done = self.start(name)
            if done.returncode != 0:
                raise RuntimeError(f"{name}: {done.stderr}")
        self.expected[name], self.counts[name], self.ways[name] = self.files(), self.told(), self.paths()

    def prepare(self, name):
        self.clear()
        if name == "load":
            shutil.rmtree(self.cache(name), ignore_errors=True)

    def try_case(self, name, kind, call, how):
        """What is wrong with how the program takes it: "" if nothing. Also what the library told."""
        if name not in self.expected:
            self.rehearse(name)
        self.prepare(name)
        try:
            done = self.start(name, f"{kind} {call} {how}")
        except subprocess.TimeoutExpired:
            return f"hangs ({self.told()['first']})", self.told()
        told = self.told()
        wrong = self.judge(name, done)
        return wrong and f"{wrong} ({told['first']})\n{done.stderr}", told

    def judge(self, name, done):
        same = SCENARIOS[name][1]
        files = self.files()
        messages = [line for line in done.stderr.splitlines() if line.startswith("roil: ")]
        for path in files:
            if path not in self.expected[name]:
                return f"leaves {path}"
        if done.returncode not in (0, 1):
            return f"ends with status {done.returncode}"
        if "cannot be waited for" in done.stderr and self.told()["exited"]:
            return "runs the handlers of exit() beside a device that is at work"
        if "VUID" in done.stderr or "vulkan validation: " in done.stderr:
            return "misuses Vulkan"
        if done.returncode == 1:
            # Where no memory is left at all, telling of that may fail for the same reason.
            if len(messages) == 2 and "out of memory" in messages[1]:
                messages.pop()
            return "" if len(messages) == 1 else f"{len(messages)} messages"
        if files.keys() != self.expected[name].keys():
            return f"leaves {sorted(files)} instead of {sorted(self.expected[name])}"
        return "draws something else" if same and files != self.expected[name] else ""


def choose(count, step):
    """All numbers of calls, or each STEP-th; without a step a sample: of equal parts one call each."""
    if step:
        return range(1, count + 1, step)
    chance = random.Random(count)
    return [int((i + chance.random()) * count / SAMPLE) + 1 for i in range(min(SAMPLE, count))]


class Faults(Case):
    step, paths, jobs, only, case = 0, False, 1, "", None
    part, parts = 1, 1

    def cases(self, stage):
        """Scenario, class, call (a number, or a path) and ways of failing."""
        if self.case:
            place, call, how = self.case.rsplit(" ", 2)
            return [(*place.split("/"), call, [how])]
        found = list(FOUND) if not self.step and self.part == 1 else []
        if self.paths:
            stage.rehearse("load")
        for name in list(SCENARIOS)[self.part - 1::self.parts]:
            for kind in CLASSES:
                if not f"{name}/{kind}".startswith(self.only):
                    continue
                if name not in stage.counts:
                    stage.rehearse(name)
                calls = choose(stage.counts[name][kind], self.step)
                if self.paths and kind == "memory":
                    calls = stage.ways[name][kind][::self.step]
                    # What other processes do is the same in all scenarios that come to it.
                    calls = [path for path in calls if name == "load" or int(path[1:], 16) & 3 == 0
                             or path not in stage.ways["load"][kind]]
                found += [(name, kind, call, ["once", "always"]) for call in calls]
        return found

    def try_case(self, stages, name, kind, call, hows):
        """A line for each way that goes wrong, and how many calls failed as they were to."""
        stage, wrong, failed = stages.get(), [], 0
        try:
            for how in hows:
                fault, told = stage.try_case(name, kind, call, how)
                failed += told["failed"] > 0
                if fault:
                    wrong.append(f"{name}/{kind} {call} {how}: {fault}")
                    print(wrong[-1], flush=True)
                if told["failed"] and not told["after"] and how != hows[-1]:
                    failed += 1  # nothing came after it that could fail: the other way is the same
                    break
        finally:
            stages.put(stage)
        return wrong, failed

    def test_what_fails_is_said(self):
        stages = queue.Queue()
        for _ in range(self.jobs):
            stages.put(Stage())
        for stage in list(stages.queue):
            self.addCleanup(shutil.rmtree, stage.root)
        first = stages.queue[0]
        cases = self.cases(first)
        tried, wrong = {}, []
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            for case, (lines, failed) in zip(cases, pool.map(lambda case: self.try_case(stages, *case), cases)):
                place = "/".join(case[:2])
                tried[place] = tried.get(place, 0) + failed
                wrong += lines
        for place, count in tried.items():
            name, kind = place.split("/")
            print(f"{place}: {count} failures of {first.counts.get(name, {}).get(kind)} calls")
        self.assertEqual(wrong, [])
        self.assertGreater(sum(tried.values()), 0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--paths", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--case")
    parser.add_argument("part", nargs="?", default="1/1")
    given, rest = parser.parse_known_args()
    Faults.step, Faults.paths, Faults.jobs = given.step if given.all else 0, given.all and given.paths, given.jobs
    Faults.only, Faults.case = given.only, given.case
    Faults.part, Faults.parts = map(int, given.part.split("/"))
    sys.argv[1:] = rest
    main()
