"""Every call of Vulkan that can fail, and every allocation, fails once, or fails from then on, while the
program loads, draws, reloads, exports and keeps a checkpoint. Then it either does its work all the same, to
the same files, or ends with status 1 and one message; it is never killed, never hangs, never misuses Vulkan,
and leaves neither a draft nor a temporary folder behind.
`../fault/fault.c` makes the calls fail.

    faults.py                                            a sample, in each run of the tests
    faults.py --all [--step 1] [--only draw/vulkan]      each call of each scenario, or each STEP-th
    faults.py --case 'draw/vulkan 120 once'              one of them
"""
import argparse
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile

from lib.program import BINARY, GROUND, PROGRAM, PUFF, Case, main

LIBRARY = os.path.join(BINARY, "libfault.so")
LIBRARIES = "liblua,libpng,libjansson"  # whose allocations fail beside the program's own
LIMIT = 60  # seconds of a run
SAMPLE = 3  # cases of each scenario, class and way in a run of the tests
SIZE = ["--size", "48x27"]

AIR = """
local fx = effect { name = "air", fps = 60, frames = 2 }
fx.camera = orbit { target = {0, 0, 0.8}, distance = 4 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, buoyancy_heat = 6, collision = "bgk" }
air:source { shape = sphere { position = {0, 0, 0.4}, radius = 0.3 }, density = 1, temperature = 2 }
fx.output = final { march { density = air.density * 30, steps = 8 } }.color
return fx
"""

SWEEP = """
return sweep { name = "edits", effect = "puff.lua", measure = "reload", size = {48, 27}, repeats = 1,
               axes = { axis { "edit", { name = "glow", edit = {"{0.4,", "{0.5,"} } } } }
"""

# By name: the command, and whether what it leaves is the same each time.
SCENARIOS = {
    "load": (["check", "puff.lua"], True),
    "draw": (["render", "puff.lua", *SIZE, "--frames", "1-2", "-o", "drawn/%d.png"], True),
    "save": (["render", "air.lua", *SIZE, "--frames", "1", "-o", "first.png", "--checkpoint", "new.state"],
             True),
    "go on": (["render", "air.lua", *SIZE, "--restore", "old.state", "--frames", "2", "-o", "second.png"],
              True),
    "export": (["export", "vdb", "air.lua", "--frames", "1", "-o", "volumes/%d.vdb"], False),
    "reload": (["bench", "sweep.lua", "-o", "measured"], False),
}
CLASSES = ("vulkan", "memory")


class Stage:
    """A scratch folder with the files of the scenarios. Compiled shaders are kept beside it, so that a run is
    short; "load" begins without."""

    def __init__(self):
        self.root = tempfile.mkdtemp(prefix="roil-faults-")
        self.folder = os.path.join(self.root, "work")
        for name in "work", "tmp":
            os.mkdir(os.path.join(self.root, name))
        self.inputs = {"puff.lua": PUFF, "ground.obj": GROUND, "air.lua": AIR, "sweep.lua": SWEEP}
        for name, text in self.inputs.items():
            with open(self.path(name), "w", encoding="utf-8") as f:
                f.write(text)
        self.expected, self.counts = {}, {}
        self.start(SCENARIOS["save"][0])
        os.rename(self.path("new.state"), self.path("old.state"))
        self.clear()

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, command, fault=None):
        environment = {**os.environ, "LD_PRELOAD": LIBRARY, "TMPDIR": os.path.join(self.root, "tmp"),
                       "ROIL_CACHE_DIR": os.path.join(self.root, "cache"), "ROIL_FAULT_LIBRARIES": LIBRARIES,
                       "ROIL_FAULT_FILE": os.path.join(self.root, "counts")}
        if fault:
            environment["ROIL_FAULT"] = fault
        return subprocess.run([PROGRAM, *command], cwd=self.folder, env=environment, timeout=LIMIT, check=False,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              errors="replace")

    def told(self):
        """What the library wrote: calls by class, how many failed, and which was the first."""
        with open(os.path.join(self.root, "counts"), "rb") as f:
            vulkan, memory, failed, place, name = struct.unpack("4Q64s", f.read())
        return {"vulkan": vulkan, "memory": memory, "failed": failed,
                "first": f"{name.split(bytes(1))[0].decode()} called at {place:#x}"}

    def files(self):
        """Contents by path of all that is here, drafts in the folder of temporary files too, and was not put here."""
        found = {}
        for top in self.folder, os.path.join(self.root, "tmp"):
            for folder, _, names in os.walk(top):
                for name in names:
                    path = os.path.relpath(os.path.join(folder, name), self.folder)
                    if path not in self.inputs and path != "old.state":
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
        command = SCENARIOS[name][0]
        for _ in range(2):
            self.prepare(name)
            done = self.start(command)
            if done.returncode != 0:
                raise RuntimeError(f"{command}: {done.stderr}")
        self.expected[name], self.counts[name] = self.files(), self.told()

    def prepare(self, name):
        self.clear()
        if name == "load":
            shutil.rmtree(os.path.join(self.root, "cache"), ignore_errors=True)

    def try_case(self, name, kind, number, how):
        """What is wrong with how the program takes it: "" if nothing. Also whether anything failed."""
        self.prepare(name)
        try:
            done = self.start(SCENARIOS[name][0], f"{kind} {number} {how}")
        except subprocess.TimeoutExpired:
            return f"hangs ({self.told()['first']})", True
        told = self.told()
        wrong = self.judge(name, done)
        return wrong and f"{wrong} ({told['first']})\n{done.stderr}", told["failed"] > 0

    def judge(self, name, done):
        same = SCENARIOS[name][1]
        files = self.files()
        messages = [line for line in done.stderr.splitlines() if line.startswith("roil: ")]
        for path in files:
            if path not in self.expected[name]:
                return f"leaves {path}"
        if done.returncode not in (0, 1):
            return f"ends with status {done.returncode}"
        if "VUID" in done.stderr or "validation" in done.stderr:
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
    step, only, case = 0, "", None

    def cases(self, stage):
        if self.case:
            place, number, how = self.case.rsplit(" ", 2)
            name, kind = place.split("/")
            stage.rehearse(name)
            yield name, kind, int(number), how
            return
        for name in SCENARIOS:
            for kind in CLASSES:
                if self.only not in f"{name}/{kind}":
                    continue
                if name not in stage.counts:
                    stage.rehearse(name)
                for how in "once", "always":
                    for number in choose(stage.counts[name][kind], self.step):
                        yield name, kind, number, how

    def test_what_fails_is_said(self):
        stage = Stage()
        self.addCleanup(shutil.rmtree, stage.root)
        injected, tried = 0, {}
        for name, kind, number, how in self.cases(stage):
            with self.subTest(f"{name}/{kind} {number} {how}"):
                wrong, failed = stage.try_case(name, kind, number, how)
                injected += failed
                tried[f"{name}/{kind}"] = tried.get(f"{name}/{kind}", 0) + failed
                if wrong and self.step:
                    print(f"{name}/{kind} {number} {how}: {wrong}", flush=True)
                self.assertEqual(wrong, "")
        for place, count in tried.items():
            print(f"{place}: {count} failures of {stage.counts[place.split('/')[0]][place.split('/')[1]]} calls")
        self.assertGreater(injected, 0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--case")
    told, rest = parser.parse_known_args()
    Faults.step, Faults.only, Faults.case = told.step if told.all else 0, told.only, told.case
    sys.argv[1:] = rest
    main()
