"""Debian's packages: made twice they are the same, need what they say, and what they hold runs."""
import os
import shutil
import subprocess
import sys
import tempfile

from lib.pictures import packed_pixels
from lib.program import BINARY, PUFF, SMALL, SOURCE, Case, main


def run(*command, **options):
    done = subprocess.run(command, text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Debian(Case):
    @classmethod
    def setUpClass(cls):
        cls.top = tempfile.mkdtemp(prefix="roil-debian-")
        cls.addClassCleanup(shutil.rmtree, cls.top)
        cls.folders = [os.path.join(cls.top, name) for name in ("once", "again")]
        for folder, umask in zip(cls.folders, (0o022, 0o077)):
            os.mkdir(folder)
            run("cpack", "--config", os.path.join(BINARY, "CPackConfig.cmake"), "-B", folder,
                "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none",  # packing takes longest, and is gzip's own
                cwd=folder, umask=umask)
        cls.files = sorted(name for name in os.listdir(cls.folders[0]) if name.endswith(".deb"))
        cls.root = os.path.join(cls.top, "root")
        for name in cls.files:
            run("dpkg-deb", "-x", os.path.join(cls.folders[0], name), cls.root)

    def test_packages_are_three(self):
        self.assertEqual([name.split("_")[0] for name in self.files], ["libroil-dev", "libroil1", "roil"])

    def test_twice_is_the_same(self):
        for name in self.files:
            with open(os.path.join(self.folders[0], name), "rb") as a, open(os.path.join(self.folders[1], name), "rb") as b:
                self.assertEqual(a.read() == b.read(), True, name)

    def test_nothing_says_where_it_was_built(self):
        """So that a build in another folder gives the same."""
        for folder, _, names in os.walk(self.root):
            for name in names:
                with open(os.path.join(folder, name), "rb") as f:
                    text = f.read()
                for path in BINARY, SOURCE:
                    self.assertEqual(path.encode() in text, False, f"{name}: {path}")

    def field(self, package, name):
        file = next(file for file in self.files if file.startswith(f"{package}_"))
        return run("dpkg-deb", "-f", os.path.join(self.folders[0], file), name)

    def test_they_say_what_they_need(self):
        for package, needs in (("roil", ("libroil1 (= ", "libglfw3", "libpopt0", "libfontconfig1")),
                               ("libroil1", ("libvulkan1", "libopenvdb10.0", "libassimp5", "liblua5.4-0", "libc6 (>=")),
                               ("libroil-dev", ("libroil1 (= ", "liblua5.4-dev"))):
            told = self.field(package, "Depends")
            for need in needs:
                self.assertIn(need, told)

    def test_every_package_has_its_licences(self):
        for package in "roil", "libroil1", "libroil-dev":
            with open(os.path.join(self.root, "usr/share/doc", package, "copyright"), encoding="utf-8") as f:
                text = f.read()
            for name in "MIT License", "glslang-dev", "spirv-tools", "libimgui-dev", "libcglm-dev":
                self.assertIn(name, text)

    def test_what_they_hold_runs(self):
        usr = os.path.join(self.root, "usr")
        for name in "bin/roil", "libexec/roil/roil-reader", "libexec/roil/roil-reader-vdb":
            told = run("objdump", "-p", os.path.join(usr, name))
            self.assertNotRegex(told, "RPATH|RUNPATH")
        plain = {name: value for name, value in os.environ.items() if not name.startswith("ROIL_")}
        self.write("puff.lua", PUFF)
        arguments = ("render", "puff.lua", "--frames", "1", *SMALL, "-o")
        run(f"{usr}/bin/roil", *arguments, "there.png", cwd=self.folder,
            env={**plain, "ROIL_CACHE_DIR": os.environ.get("ROIL_CACHE_DIR", self.path("cache"))})
        self.succeeds(*arguments, "here.png")
        self.assertEqual(packed_pixels(self.read("there.png")), packed_pixels(self.read("here.png")))
        self.assertTrue(os.path.exists(f"{usr}/share/man/man1/roil.1.gz"))


if __name__ == "__main__":
    if not all(map(shutil.which, ("cpack", "dpkg-deb", "dpkg-shlibdeps", "gzip"))):
        print("skipped: no cpack or dpkg-dev")
        sys.exit(77)
    main()
