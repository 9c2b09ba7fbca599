"""A file answers one question: 500 lines are many, more than 800 fail. Long functions are named."""
import re
import sys

sys.dont_write_bytecode = True
from lib import house

SOFT, HARD, FUNCTION = 500, 800, 120
NO_FUNCTION = re.compile(r"(typedef|struct|enum|union|extern|namespace|layout|uniform|buffer|"
                         r"static const|const)\b(?!.*\)\s*\{$)")


def functions(text):
    """(name, first line, length) of each, as the formatter lays them out."""
    start = None
    for number, line in enumerate(text, 1):
        if start is None and re.match(r"[A-Za-z_].*", line) and not line.endswith((";", ":")):
            start = number
        if start is None or not line.startswith("}"):
            if line.endswith(";") and start == number:
                start = None
            continue
        head = " ".join(text[start - 1:number])
        name = re.search(r"(\w+)\s*\(", head)
        if name and not NO_FUNCTION.match(head.split("{")[0] + "{"):
            yield name.group(1), start, number - start + 1
        start = None


def main():
    top = house.root()
    paths = (house.files(top, "src", house.CODE) + house.files(top, "shaders")
             + house.files(top, "scripts", ".lua"))
    offences = []
    for path in paths:
        text = house.lines(top, path)
        if len(text) > HARD:
            offences.append(f"{path}: {len(text)} lines; the cap is {HARD}")
        elif len(text) > SOFT:
            print(f"{path}: {len(text)} lines; consider to split it ({SOFT})")
        for name, line, length in functions(text):
            if length > FUNCTION:
                print(f"{path}:{line}: {name} has {length} lines; consider to split it")
    house.finish("sizes", len(paths), offences)


main()
