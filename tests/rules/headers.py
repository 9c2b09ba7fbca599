"""Every header compiles alone, twice over, as C17; what an embedder or vdb.cpp includes also as C++."""
import concurrent.futures
import os
import re
import sys

sys.dont_write_bytecode = True
from lib import house

WARNINGS = ["-Wall", "-Wextra", "-Werror", "-Wundef", "-Wshadow"]
C = ["-x", "c", "-std=c17", "-pedantic-errors", "-Wstrict-prototypes", "-Wdouble-promotion"]
CPP = ["-x", "c++", "-std=c++17"]
PACKAGES = ["lua5.4", "OpenEXR", "spirv-cross-c-shared", "libavformat", "libpng", "xxhash"]


def package_flags():
    flags = []
    for package in PACKAGES:
        status, text = house.run(["pkg-config", "--cflags", package])
        if status == 0:
            flags += text.split()
    return flags


def with_included(top, header, found):
    """`header` (relative to src) and the headers of ours that it includes."""
    if header in found or not os.path.exists(os.path.join(top, "src", header)):
        return
    found.add(header)
    for line in house.lines(top, os.path.join("src", header)):
        match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        if match:
            with_included(top, match.group(1), found)


def compile_alone(top, flags, header, language):
    compiler = os.environ.get("CC", "cc") if language is C else os.environ.get("CXX", "c++")
    text = f'#include "{header}"\n' * 2 + "typedef int not_empty;\n"
    command = [compiler, "-fsyntax-only", *language, *WARNINGS, "-D_GNU_SOURCE", "-Isrc",
               "-Ishaders", *flags, "-"]
    status, output = house.run(command, input=text, cwd=top)
    if status == 0:
        return None
    return f"{header}, alone as {'C' if language is C else 'C++'}:\n{output}"


def main():
    top = house.root()
    flags = package_flags()
    jobs = [(path[len("src/"):], C) for path in house.files(top, "src", ".h")]
    jobs += [(path[len("shaders/"):], C) for path in house.files(top, "shaders", "shared.h")]
    shared = set()
    for header in ("roil.h", "roil_vulkan.h", "media/vdb.h"):
        with_included(top, header, shared)
    jobs += [(header, CPP) for header in sorted(shared)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda job: compile_alone(top, flags, *job), jobs))
    house.finish("headers", len(jobs), [r for r in results if r])


main()
