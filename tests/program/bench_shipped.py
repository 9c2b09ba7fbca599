"""The sweeps that come with the program run: the first row of each, small. `bench_shipped.py 2/3` runs the
second third of them only, as ctest does."""
import json
import os
import sys

from lib.program import SOURCE, Case, main

FOLDER = os.path.join(SOURCE, "scripts/bench")
SWEEPS = sorted(name for name in os.listdir(FOLDER) if name.endswith(".lua"))
PART, PARTS = 1, 1


class Shipped(Case):
    def test_they_run_small(self):
        self.assertEqual(len(SWEEPS), 19)
        for name in SWEEPS[PART - 1::PARTS]:
            self.succeeds("bench", os.path.join(FOLDER, name), "-o", name, "--shard", "1/1000", "--size", "96x54",
                          "--frames", "30", "--warmup", "0", "--repeats", "1", "--settle", "0", "--no-reference")
            row, = json.loads(self.read(f"{name}/results.json"))["rows"]
            self.assertEqual((row["index"], row["state"]), (0, "done"))


if __name__ == "__main__":
    if len(sys.argv) > 1 and "/" in sys.argv[1]:
        PART, PARTS = map(int, sys.argv.pop(1).split("/"))
    main()
