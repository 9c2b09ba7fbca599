#!/usr/bin/env python3
"""Makes the solvers' deliberate faults (*.txt beside this) one by one, and says which the test that
is said to catch them does not: run.py [--build FOLDER] [NAME...]. All take about ten minutes on two
cores. FOLDER (default: build) holds the programs of the tests; those of faults that C compiles are
built anew, in FOLDER/mutants, where a copy of the source is changed. The exit status is 0 when all are caught."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
TOP = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, os.path.join(TOP, "tests", "rules"))
from lib import mutants

COPIED = ("CMakeLists.txt", "LICENSE", "README.md", "src", "shaders", "scripts", "effects", "tests")
SECONDS = 300


class Workshop:
    def __init__(self, build):
        self.build = os.path.abspath(build)
        self.source = os.path.join(self.build, "mutants", "source")
        self.own = os.path.join(self.build, "mutants", "build")
        shutil.rmtree(self.source, ignore_errors=True)
        os.makedirs(self.source)
        # Files are new, so that what an earlier run built of a changed one is built again.
        for name in COPIED:
            path, copy = os.path.join(TOP, name), os.path.join(self.source, name)
            if os.path.isdir(path):
                shutil.copytree(path, copy, ignore=shutil.ignore_patterns("__pycache__", "golden"),
                                copy_function=shutil.copy)
            else:
                shutil.copy(path, copy)
        self.configured = False

    def make(self, program):
        """The folder in which a program is built from the copy."""
        if not self.configured:
            cache = open(os.path.join(self.build, "CMakeCache.txt"), encoding="utf-8").read()
            launchers = re.findall(r"^(CMAKE_C(?:XX)?_COMPILER_LAUNCHER):\w+=(.+)$", cache, re.M)
            # Pictures are compared by tests that are not built here; their list is read all the same.
            shutil.copytree(os.path.join(TOP, "tests", "golden"),
                            os.path.join(self.source, "tests", "golden"))
            subprocess.run(["cmake", "-S", self.source, "-B", self.own, "-G", "Ninja",
                            "-DROIL_TESTS=ON", "-DCMAKE_BUILD_TYPE=Release",
                            *(f"-D{name}={value}" for name, value in launchers)],
                           check=True, stdout=subprocess.DEVNULL)
            self.configured = True
        subprocess.run(["cmake", "--build", self.own, "--target", program], check=True,
                       stdout=subprocess.DEVNULL)
        return self.own

    def run(self, mutant, changed):
        """What became of its test: passed, failed, or a word for what else happened."""
        folder = self.make(mutant.program) if mutant.path.endswith((".c", ".h")) else self.build
        environment = dict(os.environ, ROIL_LONG_TESTS="1", ROIL_SOURCE_DIR=self.source, ROIL_BINARY_DIR=folder,
                           ROIL_TEST_DATA=os.path.join(self.source, "tests"), ROIL_TEST=mutant.test,
                           ROIL_CACHE_DIR=os.path.join(self.build, "mutants", "cache"))
        try:
            done = subprocess.run([os.path.join(folder, mutant.program)], env=environment,
                                  cwd=os.path.join(self.source, "tests"), text=True,
                                  errors="replace", stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return f"no end after {SECONDS} s"
        if done.returncode == 77:
            return "skipped"
        if f"[ RUN      ] {mutant.test}" not in done.stdout:
            return "never ran:\n" + done.stdout
        if done.returncode == 0:
            return "passed"
        if changed and re.search(r"\.(comp|glsl|vert|frag):\d+", done.stdout):
            return "does not compile:\n" + done.stdout
        if done.returncode < 0:
            return f"ended by signal {-done.returncode}"
        return "failed"

    def try_out(self, mutant):
        path = os.path.join(self.source, mutant.path)
        whole = mutants.text(self.source, mutant.path)
        with open(path, "w", encoding="utf-8") as f:
            f.write(whole.replace(mutant.before, mutant.after))
        try:
            return self.run(mutant, True)
        finally:
            with open(path, "w", encoding="utf-8") as f:
                f.write(whole)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default=os.path.join(TOP, "build"))
    parser.add_argument("names", nargs="*", metavar="NAME")
    args = parser.parse_args()
    listed, offences = mutants.read(TOP)
    offences += mutants.find_offences(TOP, listed)
    unknown = set(args.names) - {m.name for m in listed}
    offences += [f"there is no '{name}'" for name in sorted(unknown)]
    if offences:
        sys.exit("\n".join(offences))
    chosen = [m for m in listed if not args.names or m.name in args.names]
    missing = {m.program for m in chosen if not m.path.endswith((".c", ".h"))
               and not os.path.exists(os.path.join(args.build, m.program))}
    if missing:
        sys.exit(f"not in {args.build}, build first: {' '.join(sorted(missing))}")
    shop = Workshop(args.build)
    as_it_is, counts = {}, {"caught": 0, "SURVIVED": 0, "FAULTY": 0}
    for m in chosen:
        begin = time.monotonic()
        key = m.program, m.test, m.path.endswith((".c", ".h"))
        if key not in as_it_is:
            as_it_is[key] = shop.run(m, False)
        seen = shop.try_out(m) if as_it_is[key] == "passed" else f"unchanged: {as_it_is[key]}"
        word = {"failed": "caught", "passed": "SURVIVED"}.get(seen, "FAULTY")
        counts[word] += 1
        print(f"{word:8} {m.name:36} {m.program} {m.test} ({time.monotonic() - begin:.0f} s)",
              flush=True)
        if word == "FAULTY":
            print(seen)
    print(f"{counts['caught']} of {len(chosen)} caught, {counts['SURVIVED']} survived, "
          f"{counts['FAULTY']} say nothing")
    sys.exit(0 if counts["caught"] == len(chosen) else 1)


main()
