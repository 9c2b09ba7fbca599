"""Each rule passes a small house in order, and fails when one thing in it is broken."""
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
GOOD = {
    ".clang-format": "BasedOnStyle: LLVM\nIndentWidth: 4\n",
    "src/base/error.h": "#pragma once\n#include <stdbool.h>\nbool err_set(const char *text);\n",
    "src/base/error.c": '#include "base/error.h"\n',
    "src/gpu/device.c": '#include "base/error.h"\n#include <vulkan/vulkan.h>\n',
    "src/media/vdb.cpp": "#include <openvdb/openvdb.h>\n",
    "src/pass/march/march.c": '#include "base/error.h"\n#include "shared.h"\n',
    "src/roil/roil_impl.h": '#pragma once\n#include "roil.h"\n',
    "src/roil/roil.c": '#include "roil/roil_impl.h"\n',
    "src/roil.h": '#pragma once\n#include "base/error.h"\n',
    "src/app/main.c": '#include "roil.h"\n#include <GLFW/glfw3.h>\n',
    "shaders/shared.h": "#define SHARED 1\n",
    "scripts/build": "#!/bin/sh\necho built\n",
    "tests/unit/one.c": "int works; // cmocka_unit_test(works)\n",
    "README.md": "# One house\nThe [error](src/base/error.h) of `base/error.c` is [here](#one-house).\n",
    "tests/mutants/one.txt": "wrong | shaders/shared.h | unit_one works\n- SHARED 1\n+ SHARED 2\n",
}
TOO_LONG = "int a;\n" * 801
BROKEN = [  # rule, file, text
    ("layers", "src/gpu/device.c", '#include "graph/graph.h"\n'),
    ("layers", "src/base/error.c", '#include "gpu/gpu.h"\n'),
    ("layers", "src/pass/pass.c", '#include "pass/march/bricks.h"\n'),
    ("layers", "src/pass/slices/slices.c", '#include "pass/march/bricks.h"\n'),
    ("layers", "src/sim/lbm.c", '#include "pass/pass.h"\n'),
    ("layers", "src/media/png.c", '#include "shader/shader.h"\n'),
    ("layers", "src/script/vm.c", '#include "roil.h"\n'),
    ("layers", "src/app/main.c", '#include "roil/roil_impl.h"\n'),
    ("layers", "src/pass/march/march.c", "  #  include <vulkan/vulkan.h>\n"),
    ("layers", "src/gpu/device.c", "#include <glslang/Include/glslang_c_interface.h>\n"),
    ("layers", "src/gpu/device.c", "#include <spirv_cross_c.h>\n"),
    ("layers", "src/effect/effect.c", "#include <lua.h>\n"),
    ("layers", "src/effect/effect.c", '#include "lauxlib.h"\n'),
    ("layers", "src/media/png.c", "#include <openvdb/openvdb.h>\n"),
    ("layers", "src/gpu/window.c", "#include <GLFW/glfw3.h>\n"),
    ("layers", "src/gpu/device.c", '#include "vk.h"\n'),
    ("layers", "src/gpu/device.c", '#include "../graph/graph.h"\n'),
    ("layers", "src/gpu/device.c", "#include HEADER\n"),
    ("layers", "src/gpu/device.cpp", "int a;\n"),
    ("layers", "src/util/list.c", "int a;\n"),
    ("format", "src/base/error.c", "int  a ;\n"),
    ("sizes", "src/base/error.c", TOO_LONG),
    ("sizes", "shaders/lib/noise.glsl", TOO_LONG),
    ("sizes", "scripts/prelude.lua", TOO_LONG),
    ("headers", "src/base/error.h", "#pragma once\nbool err_set(const char *text);\n"),
    ("headers", "src/base/error.h", "typedef int number;\nenum { A };\n"),
    ("headers", "src/roil.h", "#pragma once\nint delete(int class);\n"),
    ("headers", "src/base/error.h", "#pragma once\nint err_clear();\n"),
    ("words", "src/base/error.c", "// TO" "DO: later\n"),
    ("shell", "scripts/build", "#!/bin/sh\ncd $1\n"),
    ("words", "scripts/build", "# FIX" "ME\n"),
    ("words", "effects/explosion.lua", "-- XX" "X\n"),
    ("words", "tests/golden/fire.png", "tEXtroil:effect\0/home/me/fire.lua"),
    ("documents", "README.md", "a " * 60 + "\n"),
    ("documents", "src/README.md", "[error](base/errors.h)\n"),
    ("documents", "README.md", "# One house\n[here](#two-houses)\n"),
    ("documents", "README.md", "`base/errors.c`\n"),
    ("documents", "README.md", "`base/{error,errors}.c`\n"),
    ("documents", "README.md", "`errors.c`\n"),
    ("mutants", "shaders/shared.h", "#define SHARED 3\n"),
    ("mutants", "shaders/shared.h", "#define SHARED 1 // not SHARED 1\n"),
    ("mutants", "tests/unit/one.c", "int works;\n"),
    ("mutants", "tests/mutants/one.txt", "wrong | shaders/shared.h | unit_one works\n- SHARED 1\n"),
    ("mutants", "tests/mutants/two.txt", "wrong | shaders/shared.h | unit_one works\n- SHARED 1\n+ 2\n"),
    ("mutants", "tests/mutants/two.txt", "other | shaders/other.h | unit_one works\n- SHARED 1\n+ 2\n"),
]
SUBJECTS = [  # subject, good
    ("graph/compile: name cycles pass by pass", True),
    ("README: say how to begin", True),
    ("tests/rules, scripts: add", True),
    (".ci/run: print the closing count", True),
    ("graph/compile: Name cycles", False),
    ("name cycles", False),
    ("graph: name cycles.", False),
    ("feat: name cycles", False),
    ("fix(graph): name cycles", False),
    ("graph: " + "a" * 66, False),
]


def write(top, path, text):
    path = os.path.join(top, path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)


def status(rule, top):
    return subprocess.run([sys.executable, os.path.join(HERE, rule + ".py"), top], check=False,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


def try_tree(rule, changed, text):
    with tempfile.TemporaryDirectory() as top:
        for path, good in GOOD.items():
            write(top, path, good)
        if changed:
            write(top, changed, text)
        return status(rule, top)


def try_subject(subject):
    with tempfile.TemporaryDirectory() as top:
        who = ["-c", "user.name=a", "-c", "user.email=a@b"]
        for command in (["init", "-q"], [*who, "commit", "-q", "--allow-empty", "-m", subject]):
            subprocess.run(["git", "-C", top, *command], check=True)
        return status("commits", top)


def main():
    wrong, skipped, count = [], set(), 0
    cases = [(rule, None, "", 0) for rule in ("layers", "format", "sizes", "headers", "shell",
                                                "words", "documents", "mutants")]
    cases += [(rule, path, text, 1) for rule, path, text in BROKEN]
    for rule, path, text, expected in cases:
        got = try_tree(rule, path, text)
        count += 1
        if got == 77:
            skipped.add(rule)
        elif got != expected:
            wrong.append(f"{rule}: {path or 'the good house'}: status {got}, not {expected}")
    for subject, good in SUBJECTS:
        count += 1
        got = try_subject(subject)
        if got != (0 if good else 1):
            wrong.append(f"commits: '{subject}': status {got}")
    for line in wrong:
        print(line)
    for rule in sorted(skipped):
        print(f"{rule}: not tried, a program is missing")
    print(f"rules_can_fail: {count} tried, {len(wrong)} wrong")
    sys.exit(1 if wrong else 0)


main()
