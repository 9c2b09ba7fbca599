"""The README's words: its effects load and draw, its commands and options exist."""
import os
import re
import shutil

from lib.program import SMALL, SOURCE, Case, main


def readme():
    with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as f:
        return f.read()


class Readme(Case):
    def test_effects_in_it_draw(self):
        blocks = re.findall(r"```lua\n(.*?)```", readme(), re.S)
        self.assertTrue(blocks)
        shutil.copytree(os.path.join(SOURCE, "effects", "data"), self.path("data"))
        for block in blocks:
            self.write("shown.lua", block)
            self.succeeds("render", "shown.lua", "--frames", "12", "-o", "out.png", *SMALL)

    def test_options_in_it_exist(self):
        options = set(re.findall(r"--[a-z-]+", readme()))
        offered = "".join(self.succeeds(*c.split(), "--help") for c in (
            "render", "live", "export raw", "export vdb", "compare", "bench", "tune")) + "--help"
        for option in options:
            self.assertIn(option, offered)

    def test_files_in_it_exist(self):
        for name in re.findall(r"\]\(([^)#:]+)\)", readme()):
            self.assertTrue(os.path.exists(os.path.join(SOURCE, name)), name)

    def test_info_topics_in_it_exist(self):
        for words in re.findall(r"`roil info ([a-z ]+)`", readme()):
            self.succeeds("info", *words.split())


if __name__ == "__main__":
    main()
