"""The sweeps that come with the program run: the first row of each, small. Those whose effects take long to
compile, which other tests draw, are listed alone; with ROIL_LONG_TESTS=1 they run too."""
import json
import os

from lib.program import SOURCE, Case, main

FOLDER = os.path.join(SOURCE, "scripts/bench")
SWEEPS = sorted(name for name in os.listdir(FOLDER) if name.endswith(".lua"))
SLOW = {"fires.lua", "host.lua", "lighting.lua", "pyro.lua", "reload.lua", "scaling.lua", "size.lua", "slices.lua"}
LONG = os.environ.get("ROIL_LONG_TESTS") == "1"


class Shipped(Case):
    def test_their_rows_are_listed(self):
        self.assertEqual(len(SWEEPS), 19)
        for name in SWEEPS:
            self.assertTrue(self.succeeds("bench", os.path.join(FOLDER, name), "--list").splitlines(), name)

    def test_they_run_small(self):
        self.assertLessEqual(SLOW, {*SWEEPS})
        for name in SWEEPS:
            if name in SLOW and not LONG:
                continue
            self.succeeds("bench", os.path.join(FOLDER, name), "-o", name, "--shard", "1/1000", "--size", "96x54",
                          "--frames", "30", "--warmup", "0", "--repeats", "1", "--settle", "0", "--no-reference")
            row, = json.loads(self.read(f"{name}/results.json"))["rows"]
            self.assertEqual((row["index"], row["state"]), (0, "done"))


if __name__ == "__main__":
    main()
