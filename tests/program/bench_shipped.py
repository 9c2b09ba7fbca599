"""The sweeps that come with the program run: the first row of each, small."""
import json
import os

from lib.program import SOURCE, Case, main

FOLDER = os.path.join(SOURCE, "scripts/bench")
SWEEPS = sorted(name for name in os.listdir(FOLDER) if name.endswith(".lua"))


class Shipped(Case):
    def test_they_run_small(self):
        self.assertEqual(len(SWEEPS), 19)
        for name in SWEEPS:
            self.succeeds("bench", os.path.join(FOLDER, name), "-o", name, "--shard", "1/1000", "--size", "96x54",
                          "--frames", "30", "--warmup", "0", "--repeats", "1", "--settle", "0", "--no-reference")
            row, = json.loads(self.read(f"{name}/results.json"))["rows"]
            self.assertEqual((row["index"], row["state"]), (0, "done"))


main()
