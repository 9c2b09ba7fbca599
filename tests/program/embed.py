"""What `cmake --install` leaves is a component: an engine is built against it alone, and draws what `roil` draws."""
import os
import re
import shutil
import subprocess
import tempfile

from lib.pictures import packed_pixels
from lib.program import BINARY, GROUND, PROGRAM, PUFF, SOURCE, VOLUME, Case, main

ENGINE = os.path.join(SOURCE, "tests/embed/pictures.c")
ENGINE_VULKAN = os.path.join(SOURCE, "tests/embed/engine.c")
POLITE = os.path.join(SOURCE, "tests/embed/polite.c")
POINTS = os.environ.get("ROIL_TEST_POINTS", "24")  # allocations that fail; of those while it draws a quarter
WARNINGS = ["-Wall", "-Wextra", "-Werror", "-pedantic"]
BALL = VOLUME % "sphere { position = {1, 1, 1}, radius = 1 } * 3"


def run(*command, **options):
    done = subprocess.run(command, text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Embed(Case):
    @classmethod
    def setUpClass(cls):
        cls.top = tempfile.mkdtemp(prefix="roil-embed-")
        cls.addClassCleanup(shutil.rmtree, cls.top)
        installed = os.path.join(cls.top, "installed")
        run("cmake", "--install", BINARY, "--prefix", installed)
        cls.prefix = os.path.join(cls.top, "moved")  # nothing may say where it was installed
        os.rename(installed, cls.prefix)
        for name, text in ("puff.lua", PUFF), ("loud.lua", "print('said by the script')\n" + PUFF), ("ball.lua", BALL), ("ground.obj", GROUND):
            with open(os.path.join(cls.top, name), "w", encoding="utf-8") as f:
                f.write(text)
        cls.lib = os.path.dirname(cls.find(r"libroil\.so"))
        plain = {name: value for name, value in os.environ.items() if not name.startswith("ROIL_")}
        cls.environment = {**plain, "PKG_CONFIG_PATH": f"{cls.lib}/pkgconfig", "LD_LIBRARY_PATH": cls.lib,
                           **{name: os.environ[name] for name in ("ROIL_CACHE_DIR", "ROIL_VALIDATE") if name in os.environ}}
        cls.expected = []
        for name in "puff", "ball":
            run(PROGRAM, "render", f"{name}.lua", "--frames", "3", "--size", "96x54", "-o", f"{name}.png", cwd=cls.top)
            cls.expected.append(packed_pixels(cls.content(f"{name}.png")))

    @classmethod
    def content(cls, name):
        with open(os.path.join(cls.top, name), "rb") as f:
            return f.read()

    @classmethod
    def find(cls, pattern):
        """The path below the prefix whose name it is."""
        for folder, _, names in os.walk(cls.prefix):
            for name in names:
                if re.fullmatch(pattern, name):
                    return os.path.join(folder, name)
        raise AssertionError(f"{pattern} was not installed")

    def draws(self, engine, **environment):
        out = run(engine, self.folder, "puff.lua", "ball.lua", cwd=self.top, env={**self.environment, **environment})
        self.assertEqual(out, "")
        for i, expected in enumerate(self.expected):
            self.assertEqual(packed_pixels(self.read(f"{i}.png")), expected)

    def compile(self, out, language, *static, source=ENGINE, besides=()):
        compiler = {"c17": "cc", "c++17": "c++", "c++20": "c++"}[language]
        flags = run("pkg-config", *static, "--cflags", "--libs", "roil", env=self.environment).split()
        if static:
            flags = ["-l:libroil.a" if flag == "-lroil" else flag for flag in flags]
        run(compiler, "-x", language.rstrip("0127"), f"-std={language}", *(besides or WARNINGS), source, "-o",
            self.path(out), "-x", "none", *flags, *(("-lvulkan", "-lm") if besides else ()), env=self.environment)
        return self.path(out)

    def test_by_pkg_config(self):
        self.draws(self.compile("engine", "c17"))
        self.draws(self.compile("engine", "c++17"))

    def test_static_by_pkg_config(self):
        """The engine's own file does not lie near what roil needs, so it says where that is."""
        self.draws(self.compile("engine", "c17", "--static"), ROIL_HOME=f"{self.prefix}/share/roil",
                   ROIL_READER=self.find("roil-reader"), LD_LIBRARY_PATH="")

    def test_by_cmake(self):
        build = self.path("build")
        run("cmake", "-S", os.path.dirname(ENGINE), "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
            env=self.environment)
        run("cmake", "--build", build, env=self.environment)
        self.draws(f"{build}/engine_c", LD_LIBRARY_PATH="")
        self.draws(f"{build}/engine_cpp", LD_LIBRARY_PATH="")
        self.have_effects(f"{build}/engine_vulkan", f"{build}/engine_vulkan_cpp",
                          *(self.compile(f"by-{language}", language, source=ENGINE_VULKAN, besides=[f"-I{build}/embed"])
                            for language in ("c17", "c++20")))
        self.draws(f"{build}/engine_archive", ROIL_HOME=f"{self.prefix}/share/roil", ROIL_READER=self.find("roil-reader"))

    def have_effects(self, *engines):
        """Engines with a Vulkan device of their own draw what the one of this build does, which program/host.py looks at."""
        effects = [os.path.join(os.path.dirname(ENGINE), name) for name in ("far.lua", "near.lua")]
        pictures = set()
        for program in *engines, os.path.join(BINARY, "engine"):
            run(program, *effects, self.path("engine.pfm"), "3", env={**os.environ, "LD_LIBRARY_PATH": self.lib})
            pictures.add(self.read("engine.pfm"))
        self.assertEqual(len(pictures), 1)

    def test_as_a_part_of_a_build(self):
        """It can be configured, and needs neither the window nor the options; building all again takes too long."""
        build = self.path("build")
        run("cmake", "-S", os.path.dirname(ENGINE), "-B", build, "-G", "Ninja", f"-DROIL_SOURCE={SOURCE}",
            "-DCMAKE_DISABLE_FIND_PACKAGE_glfw3=ON", env=self.environment)
        targets = run("ninja", "-C", build, "-t", "targets", "all")
        self.assertIn("engine_c:", targets)
        self.assertNotIn("roil_app", targets)
        place = self.path("build/_deps/roil-build")  # with what would be built there it finds the rest
        for name in r"libroil\.so\.1", "roil-reader", "roil-reader-vdb":
            shutil.copy(self.find(name), place)
        self.draws(self.compile("engine", "c17"), LD_LIBRARY_PATH=place)

    def told_by(self, *arguments):
        """What a host that is hard to live with says; it draws the effect that is named."""
        host = self.compile("polite", "c17", source=POLITE)
        done = subprocess.run([host, *arguments], cwd=self.top, text=True, check=False, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, env={**self.environment, "LOCPATH": os.path.join(BINARY, "locale")})
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def test_many_threads_in_a_strange_process(self):
        self.assertEqual(self.told_by("threads", "loud.lua"), "64 threads, 2 of them drew\n")

    def test_memory_that_fails_is_an_error_of_the_call(self):
        told = self.told_by("memory", "puff.lua", POINTS)
        self.assertEqual(len(re.findall(r"(\d+) of \d+ uses failed", told)), 2, told)
        print(told, end="")

    def test_numbers_of_a_frame_are_cheap(self):
        told = self.told_by("numbers", "puff.lua")
        print(told, end="")
        by_number, by_text = map(float, re.search(r"([\d.]+) us or ([\d.]+) us", told.replace(",", ".")).groups())
        self.assertLess(by_number, by_text)

    def test_exports_what_the_headers_declare(self):
        declared = set()
        headers = os.path.dirname(self.find(r"roil\.h"))
        for name in os.listdir(headers):
            with open(os.path.join(headers, name), encoding="utf-8") as f:
                text = re.sub(r"//.*", "", f.read())
            declared |= set(re.findall(r"\b(roil_\w+)\(", text))
        for options, file in (("-D",), self.find(r"libroil\.so")), (("-g",), self.find(r"libroil\.a")):
            lines = run("nm", *options, "--defined-only", file).splitlines()
            self.assertEqual({line.split()[-1] for line in lines if len(line.split()) == 3}, declared)

    def test_shared_library_has_a_version_and_few_needs(self):
        told = run("objdump", "-p", self.find(r"libroil\.so"))
        self.assertRegex(told, r"SONAME\s+libroil\.so\.\d+\n")
        self.assertNotRegex(told, "RPATH|RUNPATH")
        self.assertNotRegex(told, r"NEEDED\s+lib(openvdb|assimp|tbb|av\w+|glfw|stdc\+\+)")

    def test_completion_and_manual_know_every_option(self):
        bash, zsh, page = (self.content(os.path.join(self.prefix, "share", name)).decode() for name in (
            "bash-completion/completions/roil", "zsh/site-functions/_roil", "man/man1/roil.1"))
        for command in ("render", "live", "new", "check", "info", "export", "export vdb", "export sheet", "bundle", "bench", "tune",
                        "repro", "compare"):
            options = set(re.findall(r"(?m)^  (?:-\w,|   ) (--[a-z0-9-]+)", run(PROGRAM, *command.split(), "--help")))
            line = re.search(rf"'{command}'\) words='(.*)' ;;", bash).group(1).split()
            section = zsh.split(f"'{command}') _arguments")[1].split(" ;;")[0]
            self.assertIn("--usage", options)
            for option in options - {"--help", "--usage"}:
                self.assertIn(option, line)
                self.assertIn(f"'*{option}[", section)
                self.assertIn(option.replace("-", r"\-"), page)

    def completes(self, *words):
        script = f"source {self.prefix}/share/bash-completion/completions/roil; COMP_WORDS=(\"$@\")\n" \
                 "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _roil; printf '%s\\n' \"${COMPREPLY[@]}\""
        return run("bash", "-c", script, "bash", "roil", *words, cwd=self.folder).split()

    def test_bash_completes(self):
        self.assertEqual(self.completes("re"), ["render", "repro"])
        self.assertEqual(self.completes("render", "--frames", "1", "--fr"), ["--frames", "--from"])
        self.assertEqual(self.completes("export", "vdb", "--fie"), ["--fields"])
        self.assertEqual(self.completes("render", "grou"), ["ground.obj"])


if __name__ == "__main__":
    main()
