"""Includes go downward, and each foreign library has one home."""
import re
import sys

sys.dont_write_bytecode = True
from lib import house

LEVELS = [["base"], ["gpu"], ["media", "shader"], ["graph", "kernel", "reader"], ["field"], ["scene"],
          ["sim"], ["pass"], ["effect"], ["script"], ["roil"], ["bench", "ui"], ["app"]]
LEVEL = {layer: level for level, layers in enumerate(LEVELS) for layer in layers}

# Foreign header -> where it may be included: a layer (all its files), layers, or a file.
HOMES = [
    (r"vulkan/|vk_|volk\.h|vulkan", ("gpu/", "roil_vulkan.h")),
    (r"spirv_cross/(spirv|GLSL\.std\.450)\.h", ("shader/", "gpu/")),
    (r"glslang/|SPIRV/|spirv_cross/(?!spirv\.h|GLSL\.std)|spirv-cross|spirv(?!_cross/)", "shader/"),
    (r"(lua|lauxlib|lualib|luaconf)\.h(pp)?$|lua5\.4/", "script/"),
    (r"openvdb/|nanovdb/|tbb/", ("media/vdb.cpp", "media/vdb_blocks.cpp", "media/vdb_write.cpp",
                                 "media/vdb_file.hpp")),
    (r"blosc", "media/pack.c"),
    (r"assimp/|meshoptimizer\.h|png\.h|OpenEXR/|openexr|libav|libsw|Imf", "media/"),
    (r"opencv2/", "media/optical/optical_flow.cpp"),
    (r"imgui", ("ui/ui.cpp", "ui/ui_canvas.cpp", "ui/ui_widgets.cpp", "ui/ui_state.hpp")),
    (r"GLFW/", ("app/", "ui/")),
    (r"fontconfig/", "ui/"),
    (r"popt\.h", "app/"),
    (r"xxhash\.h", "base/"),
]
CPP = ["src/media/vdb.cpp", "src/media/vdb_blocks.cpp", "src/media/vdb_write.cpp",
       "src/media/optical/optical_flow.cpp", "src/ui/ui.cpp", "src/ui/ui_canvas.cpp", "src/ui/ui_widgets.cpp"]
PUBLIC = ("roil.h", "roil_edits.h", "roil_export.h", "roil_graph.h", "roil_host.h", "roil_info.h", "roil_live.h",
          "roil_slices.h", "roil_space.h", "roil_vulkan.h", "roil_window.h")  # of the layer roil
INCLUDE = re.compile(r'^\s*#\s*(?:include|import)\b\s*(?:"([^"]*)"|<([^>]*)>|(.*))')


def layer_of(path):  # relative to src
    folder, slash, _ = path.partition("/")
    return folder if slash else "roil"


def room_of(path):
    """A folder of a layer: pass/march/. What stands beside such folders is the layer's core, which they
    may include; it includes none of them, and they do not include each other."""
    return path.rpartition("/")[0].partition("/")[2]


def judge_own(path, target):
    """A quoted include; `path` and `target` are relative to src."""
    mine = layer_of(path)
    if target == "shared.h" or target.startswith("lib/"):
        return None  # of shaders/: constants and functions that C and GLSL share
    theirs = layer_of(target)
    if "/" not in target and target not in PUBLIC or theirs not in LEVEL:
        return f'"{target}": write "layer/file.h", relative to src'
    if theirs == "roil" != mine and target not in PUBLIC:
        return f'"{target}" is private to the library; use roil.h'
    if theirs == mine and room_of(target) not in ("", room_of(path)):
        return f'"{target}": {room_of(path) or "the core of " + mine} may not include {room_of(target)}'
    if theirs == mine or LEVEL[theirs] < LEVEL[mine]:
        return None
    return f'"{target}": {mine} may not include {theirs}'


def judge_foreign(path, target):
    for pattern, home in HOMES:
        if re.match(pattern, target) and not path.startswith(home):
            homes = home if isinstance(home, str) else " and src/".join(home)
            return f"<{target}> belongs to src/{homes} alone"
    return None


def judge(path, number, line):
    match = INCLUDE.match(line)
    if not match:
        return None
    quoted, angled, other = match.groups()
    if other is not None:
        why = f"include of a macro: {other}"
    elif quoted is not None:
        why = judge_own(path, quoted) or judge_foreign(path, quoted)
    else:
        why = judge_foreign(path, angled)
    return why and f"src/{path}:{number}: {why}"


def main():
    top = house.root()
    offences = []
    paths = house.files(top, "src", house.CODE)
    for path in paths:
        inside = path[len("src/"):]
        if layer_of(inside) not in LEVEL:
            offences.append(f"{path}: '{layer_of(inside)}' is not a layer")
            continue
        if path.endswith(".cpp") and path not in CPP:
            offences.append(f"{path}: C++ lives in {' and '.join(CPP)} alone")
        for number, line in enumerate(house.lines(top, path), 1):
            offence = judge(inside, number, line)
            if offence:
                offences.append(offence)
    house.finish("layers", len(paths), offences)


main()
