"""effects/README.md teaches what its steps' files say: its lines are theirs, its commands draw."""
import glob
import os
import re

from lib.program import SMALL, SOURCE, Case, main

EFFECTS = os.path.join(SOURCE, "effects")


def text_of(name):
    with open(os.path.join(EFFECTS, name), encoding="utf-8") as f:
        return f.read()


def chapters():
    """(its file, text) of each step, by the file that its heading links to."""
    return re.findall(r"^## \[[^\]]*\]\(([^)]*)\)\n(.*?)(?=^#{1,2} |\Z)", text_of("README.md"), re.M | re.S)


class Steps(Case):
    def test_every_step_has_a_chapter_in_order(self):
        files = [os.path.basename(path) for path in sorted(glob.glob(os.path.join(EFFECTS, "step-*.lua")))]
        self.assertEqual(len(files), 10)
        self.assertEqual([name for name, _ in chapters()], files)

    def test_lines_shown_are_those_of_the_file(self):
        for name, text in chapters():
            blocks = re.findall(r"```(lua|glsl)\n(.*?)```", text, re.S)
            self.assertTrue(blocks, name)
            for kind, block in blocks:
                beside = [name] if kind == "lua" else re.findall(r'"(step-[^"]*\.comp)"', text_of(name))
                whole = "".join(text_of(file) for file in beside)
                for piece in block.split("...\n"):
                    with self.subTest(name, piece=piece):
                        self.assertIn(piece, whole)

    def test_commands_of_the_files_draw(self):
        for name, _ in chapters():
            command = re.search(r"^--   roil (render \S+ .*-o (\S+))$", text_of(name), re.M)
            self.assertTrue(command, f"{name} says no command")
            words = command.group(1).split()
            self.assertEqual(words[1], f"effects/{name}")
            words[1] = os.path.join(SOURCE, words[1])
            with self.subTest(name):
                self.succeeds(*words, *SMALL)
                self.assertTrue(os.path.exists(self.path(command.group(2))))

    def test_commands_of_the_readme_name_what_exists(self):
        commands = re.findall(r"(?:^|`)build/roil (\w+) (effects/\S+?)(?:`|$| )(.*)", text_of("README.md"), re.M)
        self.assertTrue(commands)
        for verb, file, rest in commands:
            self.assertTrue(os.path.exists(os.path.join(SOURCE, file)), file)
            offered = self.succeeds(verb, "--help")
            for option in re.findall(r"--[a-z-]+", rest):
                self.assertIn(option, offered)

    def test_links_and_pictures_exist(self):
        for name in re.findall(r"\]\(([^)#:]+)\)", text_of("README.md")):
            self.assertTrue(os.path.exists(os.path.join(EFFECTS, name)), name)


if __name__ == "__main__":
    main()
