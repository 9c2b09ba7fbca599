"""The words of the documents: the effects that README.md shows draw, the commands and options that any of
them names exist."""
import os
import re
import shutil
import subprocess

from lib.program import SMALL, SOURCE, Case, main

FOLDERS = ("src", "effects", "scripts", "tests")


def text_of(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as f:
        return f.read()


def documents():
    """Paths, relative to the source, of README.md and of the documents in its folders."""
    found = ["README.md"]
    for folder in FOLDERS:
        for here, _, names in os.walk(os.path.join(SOURCE, folder)):
            found += [os.path.relpath(os.path.join(here, name), SOURCE) for name in names if name.endswith(".md")]
    return found


class Readme(Case):
    def test_effects_in_it_draw(self):
        blocks = re.findall(r"```lua\n(.*?)```", text_of("README.md"), re.S)
        self.assertTrue(blocks)
        shutil.copytree(os.path.join(SOURCE, "effects", "data"), self.path("data"))
        for block in blocks:
            self.write("shown.lua", block)
            self.succeeds("render", "shown.lua", "--frames", "12", "-o", "out.png", *SMALL)

    def test_options_in_it_exist(self):
        text = re.sub(r"\b(cmake|pkg-config) [^`)\n]*", "", text_of("README.md"))  # which have options of their own
        options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text))
        offered = "".join(self.succeeds(*c.split(), "--help") for c in (
            "render", "live", "new", "check", "info", "export raw", "export vdb", "export sheet", "compare", "repro", "bundle", "bench", "tune")) + "--help"
        offered += subprocess.run([os.path.join(SOURCE, "scripts/farm"), "--help"], stdout=subprocess.PIPE, text=True,
                                  check=True).stdout
        for option in options:
            self.assertIn(option, offered)

    def test_commands_in_documents_exist(self):
        helps = {}
        for path in documents():
            for verb, rest in re.findall(r"\broil (export \w+|[a-z]+)( [^`\n]*--[^`\n]*)", text_of(path)):
                if verb not in helps:
                    helps[verb] = self.succeeds(*verb.split(), "--help") + "--help"
                for option in re.findall(r"(?<![\w-])--[a-z][a-z-]*", rest):
                    with self.subTest(path, command=f"roil {verb}{rest}"):
                        self.assertIn(option, helps[verb])
        self.assertIn("render", helps)

    def test_info_topics_in_documents_exist(self):
        for path in documents():
            for words in re.findall(r"\broil info ((?:passes|fields)(?: \w+)?)\b", text_of(path)):
                if words.split()[-1].islower():  # not NAME
                    self.succeeds("info", *words.split())


if __name__ == "__main__":
    main()
