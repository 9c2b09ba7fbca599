"""Shell scripts are free of what shellcheck warns of."""
import sys

sys.dont_write_bytecode = True
from lib import house


def is_shell(top, path):
    text = house.lines(top, path)
    return bool(text) and text[0] in ("#!/bin/sh", "#!/bin/bash")


def main():
    top = house.root()
    paths = [path for folder in ("scripts", ".ci", "tests") for path in house.files(top, folder)
             if is_shell(top, path)]
    offences = []
    if paths:
        status, text = house.run(["shellcheck", *paths], cwd=top)
        if status != 0:
            offences.append(text)
    house.finish("shell", len(paths), offences)


main()
