"""Documents wrap at 110 columns, and what they link to or name as a file is there."""
import fnmatch
import os
import re
import sys

sys.dont_write_bytecode = True
from lib import house

COLUMNS = 110
SOURCES = (".c", ".h", ".cpp", ".comp", ".vert", ".frag", ".glsl", ".lua", ".py", ".md")
BESIDE = ("", "src", "shaders", "scripts", "effects")  # where a name with a folder may begin
FENCE = re.compile(r"^\s*```")
LINK = re.compile(r"\]\(([^)\s]+)\)")
UNBROKEN = re.compile(r"`[^`]*`|!?\[[^\]]*\]\([^)]*\)|\S+")


def prose(lines):
    """(number, line) of each line outside of blocks of code."""
    code = False
    for number, line in enumerate(lines, 1):
        if FENCE.match(line):
            code = not code
        elif not code:
            yield number, line


def is_long(line):
    """What cannot be broken may be longer: a table, a heading, a link, a piece of code."""
    words = UNBROKEN.findall(line.strip().lstrip("-* "))
    return len(line) > COLUMNS and len(words) > 1 and not line.lstrip().startswith(("|", "#", "!["))


def anchors(lines):
    heads = [re.sub(r"^#+ ", "", line) for _, line in prose(lines) if re.match(r"#+ ", line)]
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def judge_link(top, path, target):
    file, _, anchor = target.partition("#")
    if ":" in file:
        return None
    there = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
    if not os.path.exists(os.path.join(top, there)):
        return f"there is no {there}"
    if anchor and anchor not in anchors(house.lines(top, there)):
        return f"{there} has no heading '{anchor}'"
    return None


def expand(name):
    """The names that "lbm/{step.comp,alone.glsl}" stands for."""
    match = re.search(r"\{([^}]*)\}", name)
    if not match:
        return [name]
    return [one for word in match.group(1).split(",")
            for one in expand(name[:match.start()] + word + name[match.end():])]


def is_there(path, name, files):
    """A name without a folder may be of any file; all others are of files where they say."""
    if "/" not in name:
        return any(fnmatch.fnmatch(os.path.basename(file), name) for file in files)
    places = [os.path.normpath(os.path.join(folder, name)) for folder in (os.path.dirname(path), *BESIDE)]
    return any(fnmatch.fnmatch(file, place) for place in places for file in files)


def judge_names(path, line, files):
    for name in re.findall(r"`([\w./*{},-]+)`", line):
        if not name.endswith(SOURCES + ("}",)) or name.startswith(".") and "/" not in name:
            continue
        for one in expand(name):
            if one.endswith(SOURCES) and not re.search(r"\b[A-Z]{4,}\b(?!\.md)|^out/|^build/|_NAME", one) \
                    and not is_there(path, one, files):
                yield f"there is no file {one}"


def main():
    top = house.root()
    files = [path for folder in ("src", "shaders", "scripts", "effects", "tests") for path in house.files(top, folder)]
    paths = [path for path in ["README.md", *files] if path.endswith(".md")]
    offences = []
    for path in paths:
        for number, line in prose(house.lines(top, path)):
            why = [f"{len(line)} columns, of {COLUMNS}"] if is_long(line) else []
            why += [judge_link(top, path, target) for target in LINK.findall(line)]
            why += judge_names(path, line, files)
            offences += [f"{path}:{number}: {one}" for one in why if one]
    house.finish("documents", len(paths), offences)


main()
