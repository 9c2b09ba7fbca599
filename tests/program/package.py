"""scripts/package: a folder that can lie anywhere, and needs nothing of the build."""
import os
import re
import shutil
import subprocess
import tempfile

from lib.program import BINARY, PROGRAM, PUFF, SMALL, SOURCE, Case, main

HIDE = ["unshare", "--map-root-user", "--mount", "sh", "-c",
        'for folder in "$1" "$2"; do mount -t tmpfs none "$folder" || exit 99; done; shift 2; exec "$@"', "hide"]


class Package(Case):
    @classmethod
    def setUpClass(cls):
        cls.top = tempfile.mkdtemp(prefix="roil-package-")
        cls.addClassCleanup(shutil.rmtree, cls.top)
        cls.package = os.path.join(cls.top, "here")
        subprocess.run([os.path.join(SOURCE, "scripts/package"), "--folder", cls.package], check=True,
                       env={**os.environ, "ROIL_BINARY_DIR": BINARY})

    def run_hidden(self, *args):
        """Where mounting is allowed, without the source and the build."""
        command = [*HIDE, SOURCE, os.path.realpath(BINARY)]
        may = subprocess.run([*command, "true"], capture_output=True, check=False).returncode == 0
        plain = {name: value for name, value in os.environ.items() if not name.startswith("ROIL_")}
        return subprocess.run([*(command if may else []), *args], cwd="/", text=True, check=False,
                              capture_output=True, env={**plain, "ROIL_CACHE_DIR": self.path("cache")})

    def test_runs_where_it_lies(self):
        done = self.run_hidden(f"{self.package}/bin/roil", "render", f"{self.package}/share/roil/effects/explosion.lua",
                               "--frames", "30", "--size", "96x54", "-o", self.path("there.png"),
                               "-o", self.path("there.mp4"))
        self.assertEqual(done.returncode, 0, done.stderr)
        subprocess.run([PROGRAM, "render", f"{SOURCE}/effects/explosion.lua", "--frames", "30",
                        "--size", "96x54", "-o", self.path("here.png")], check=True, capture_output=True)
        alike = subprocess.run([PROGRAM, "compare", self.path("there.png"), self.path("here.png"),
                                "--max-flip", "0"], check=False, capture_output=True)
        self.assertEqual(alike.returncode, 0)
        self.assertGreater(os.path.getsize(self.path("there.mp4")), 500)

    def test_films_need_no_coders_but_theirs(self):
        """What stands in for the others is tried even where the machine has the real ones."""
        coders = [f"{self.package}/lib/fallback/{name}" for name in os.listdir(f"{self.package}/lib/fallback")
                  if re.match(r"lib(aom|codec2|rav1e|rsvg-2|SvtAv1Enc|x265)\.so", name)]
        self.assertEqual(len(coders), 6)
        self.assertLess(max(os.path.getsize(coder) for coder in coders), 20000)
        self.write("puff.lua", PUFF)
        done = self.run_hidden("env", f"LD_PRELOAD={':'.join(coders)}", f"{self.package}/bin/roil", "render",
                               self.path("puff.lua"), "--frames", "0-3", *SMALL, "-o", self.path("puff.mp4"))
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("puff.mp4"), "rb") as film:
            self.assertIn(b"x264", film.read())
        done = self.run_hidden(f"{self.package}/bin/roil", "render", self.path("puff.lua"), "--frames", "0-3", *SMALL,
                               "-o", self.path("puff.webm"), "-o", self.path("puff.mov"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(os.path.getsize(self.path("puff.webm")), 300)

    def test_it_brings_the_farm(self):
        self.write("puff.lua", PUFF)
        for tool in ("dirname", "sed"):  # a machine without Slurm
            os.makedirs(self.path("tools"), exist_ok=True)
            os.symlink(shutil.which(tool), self.path("tools/" + tool))
        farm = ["env", "PATH=" + self.path("tools"), f"{self.package}/bin/roil-farm"]
        self.assertIn("--shards 8", self.run_hidden(*farm, "--help").stdout)
        done = self.run_hidden(*farm, "frames", self.path("puff.lua"), "-o", self.path("%d.png"), "--frames", "1-4", "--shards", "2")
        self.assertEqual(done.stderr, "farm: there is no sbatch here: Slurm shares the work (Debian: slurm-wlm)\n")

    def test_libraries_are_its_own(self):
        loaded = "".join(self.run_hidden("env", "LD_TRACE_LOADED_OBJECTS=1", f"{self.package}/{program}").stdout
                         for program in ("bin/roil", "libexec/roil/roil-reader", "libexec/roil/roil-reader-vdb"))
        self.assertNotIn("not found", loaded)
        for name in ("libopenvdb", "libassimp", "liblua5.4", "libspirv-cross"):
            path = re.search(rf"{name}\S* => (\S+)", loaded).group(1)
            self.assertTrue(os.path.realpath(path).startswith(os.path.realpath(self.package)), path)
        for name in ("libstdc++.so.6", "libvulkan.so.1", "libz.so.1"):  # for a machine that has none
            self.assertTrue(os.path.exists(f"{self.package}/lib/fallback/{name}"), name)
        self.assertFalse([name for name in os.listdir(f"{self.package}/lib") if name.startswith("libc.")])
        for name in ("libavcodec59", "glslang-dev", "spirv-tools", "libimgui-dev", "libcglm-dev", "roil"):
            self.assertTrue(os.path.getsize(f"{self.package}/licences/{name}"), name)

    def test_stays_small(self):
        """The quickest compression stands for the thorough one, which takes off a sixth more."""
        if os.environ.get("ROIL_LONG_TESTS") != "1":
            print("left out: the size of the package, packed in 17 s; set ROIL_LONG_TESTS=1")
            return
        tar = subprocess.Popen(["tar", "-C", self.package, "-cf", "-", "."], stdout=subprocess.PIPE)
        with tar, open(self.path("quick.xz"), "wb") as out:
            subprocess.run(["xz", "--x86", "--lzma2=preset=0"], stdin=tar.stdout, stdout=out, check=True)
        self.assertEqual(tar.returncode, 0)
        self.assertLess(os.path.getsize(self.path("quick.xz")), 60 << 20)


if __name__ == "__main__":
    main()
