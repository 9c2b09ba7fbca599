"""C and C++ look as .clang-format says. Shaders are laid out by hand."""
import sys

sys.dont_write_bytecode = True
from lib import house


def main():
    top = house.root()
    paths = house.files(top, "src", house.CODE) + house.files(top, "tests", house.CODE)
    offences = []
    if paths:
        command = ["clang-format", "--style=file", "--dry-run", "-Werror", *paths]
        status, text = house.run(command, cwd=top)
        if status != 0:
            offences = sorted({line.split(":")[0] for line in text.splitlines()
                               if "clang-format-violations" in line}) or [text]
            offences = [f"{path}: run clang-format -i on it" for path in offences]
    house.finish("format", len(paths), offences)


main()
