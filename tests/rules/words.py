"""What is committed is finished: no notes to self, and no picture that says where on a machine it was made."""
import re
import sys

sys.dont_write_bytecode = True
from lib import house

# In two parts, so that this file keeps its own rule.
NOTES = re.compile(r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
# Of the texts that roil writes into its pictures.
PLACES = re.compile(rb'roil:effect\0+/|"effect":"/')
FOLDERS = ["src", "shaders", "scripts", "effects", "tests", ".ci"]
ENDINGS = (".c", ".h", ".cpp", ".lua", ".py", ".sh", ".txt", ".md", ".comp", ".vert", ".frag",
           ".glsl", "/setup", "/build", "/demo", "/test", "/run")


def main():
    top = house.root()
    paths = [path for folder in FOLDERS for path in house.files(top, folder)
             if ("/" + path).endswith(ENDINGS)]
    offences = [f"{path}:{number}: {line.strip()}" for path in paths
                for number, line in enumerate(house.lines(top, path), 1) if NOTES.search(line)]
    pictures = [path for folder in ("effects", "tests") for path in house.files(top, folder, ".png")]
    offences += [f"{path}: says in which folder its effect lies" for path in pictures
                 if PLACES.search(house.content(top, path))]
    house.finish("words", len(paths) + len(pictures), offences)


main()
