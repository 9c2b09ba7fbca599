"""The reference: every pass and field is told about, and what it names exists."""
import glob
import os
import re
import shutil
import subprocess

from lib.program import CORPUS, PUFF, SOURCE, Case, main


def names(listing):
    """The first words of indented lines: "  march      marches a ray ..."."""
    return re.findall(r"^  (\w+)(?: |$)", listing, re.MULTILINE)


class Info(Case):
    def test_devices(self):
        for text in (self.succeeds("info"), self.succeeds("info", "device")):  # an index stands before the former
            self.assertRegex(text, r"(?m)^0  .+ \((software|[a-z]+ GPU|other)\)\n   driver .+Vulkan 1\.")

    def test_every_pass(self):
        listing = self.succeeds("info", "passes")
        passes = names(listing)
        for name in ("geometry", "shade", "march", "over", "bright", "bloom", "final"):
            self.assertIn(name, passes)
        for name in passes:
            with self.subTest(name):
                text = self.succeeds("info", "passes", name)
                self.assertTrue(text.startswith(name + "\n"))
                for part in ("uniforms", "resolution", "outputs"):
                    self.assertIn(part, text)

    def test_every_field(self):
        fields = names(self.succeeds("info", "fields"))
        for name in ("perlin", "simplex", "value", "worley", "curl", "sphere", "box", "capsule", "torus",
                     "warp", "mix", "smoothstep", "palette"):
            self.assertIn(name, fields)
        for name in fields:
            with self.subTest(name):
                self.assertTrue(self.succeeds("info", "fields", name).startswith(name + " ("))

    def test_unknown_names_get_a_suggestion(self):
        self.fails(1, ["unknown pass 'marsh'", "did you mean 'march'?"], "info", "passes", "marsh")
        self.fails(1, ["unknown field 'wurley'", "did you mean 'worley'?"], "info", "fields", "wurley")
        self.fails(1, "unknown pass 'teapot'", "info", "passes", "teapot")
        self.fails(1, "unknown field 'teapot'", "info", "fields", "teapot")

    def parameters(self):
        """Pairs of a name, as --set takes it, and a value."""
        self.write("puff.lua", PUFF)
        section, pairs = "", []
        for line in self.succeeds("info", "params", "puff.lua").splitlines():
            title = re.fullmatch(r"(\w+\.)\*|(parameters)", line)
            entry = re.match(r"  (\w+) = (.+)", line)
            if title:
                section = title[1] or ""
            elif entry:
                pairs.append((section + entry[1], entry[2]))
        return pairs

    def test_parameters(self):
        shown = dict(self.parameters())
        self.assertRegex(shown["thickness"], r"4 \[0, 100\] 1/m +of the smoke")
        self.assertRegex(shown["look"], r"soft\* \| hard +nothing")
        self.assertRegex(shown["march.shadow_steps"], "^2 ")  # what the effect says, not the default
        for name in ("steps", "march.albedo", "march.mode", "final.exposure_ev"):
            self.assertIn(name, shown)

    def test_memory(self):
        self.write("puff.lua", PUFF)
        self.assertRegex(self.succeeds("info", "params", "puff.lua", "--memory", "512M"),
                         r"\nloaded: [\d.]+ MiB of memory of the 512 MiB that may be taken; "
                         r"the script and what it declares [\d.]+ MiB")

    def test_parameters_that_are_shown_can_be_set(self):
        settings = []
        for name, text in self.parameters():
            value = re.match(r"-?[\d.]+(, -?[\d.]+)*|true|false", text) or re.search(r"\w+(?=\*)", text)
            settings += ["--set", f"{name}={value[0].replace(' ', '')}"]
        self.assertGreater(len(settings), 30)
        self.succeeds("render", "puff.lua", "--frames", "1", "--size", "8x8", "-o", "out.png", *settings)

    def test_graph(self):
        self.write("puff.lua", PUFF)
        text = self.succeeds("info", "graph", "puff.lua")
        self.assertTrue(text.startswith("digraph"))
        for name in ("geometry", "march", "over", "final"):
            self.assertIn(name, text)
        self.assertEqual(text.count("{"), text.count("}"))
        if not shutil.which("dot"):
            self.skipTest("dot is not installed")
        subprocess.run(["dot", "-Tsvg", "-o", os.devnull], input=text, text=True, check=True)

    def test_volume_files(self):
        text = self.succeeds("info", os.path.join(CORPUS, "fuzz_vdb/float.vdb"))
        self.assertIn("density: float, fog volume, voxel 0.5 x 0.5 x 0.5 m", text)
        self.assertIn("300 active voxels", text)
        low, high = re.search(r"box \((.*)\) to \((.*)\) m", text).groups()
        side = min(float(b) - float(a) for a, b in zip(low.split(","), high.split(",")))
        said = re.search(r"(\S+) m along its shortest side: .* density \* (\S+) is opaque", text)
        self.assertAlmostEqual(float(said[1]), side, places=4)
        self.assertAlmostEqual(float(said[2]) * side, 3, delta=0.2)
        self.fails(1, "none.vdb", "info", "none.vdb")

    def test_bad_effects(self):
        self.fails(1, "none.lua", "info", "params", "none.lua")
        self.write("bad.lua", "fx = = 1\n")
        self.fails(1, "bad.lua:1:", "info", "graph", "bad.lua")

    def test_shipped_effects(self):
        effects = sorted(glob.glob(os.path.join(SOURCE, "effects/*.lua")))
        self.assertTrue(effects)
        done = self.succeeds("check", *effects)
        self.assertEqual(done.count(": good\n"), len(effects))
        for effect in effects:
            self.assertTrue(self.succeeds("info", "params", effect))
            self.assertTrue(self.succeeds("info", "graph", effect).startswith("digraph"))


if __name__ == "__main__":
    main()
