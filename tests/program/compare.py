"""The comparison of golden pictures: what it lets pass, and what not."""
import os

from lib.pictures import Png, write_png
from lib.program import BINARY, Case, main


class Compare(Case):
    def compare(self, actual, width=160, height=80):
        def ramp(x, y):
            return (x, y * 2, 100)
        write_png(self.path("expected.png"), 160, 80, ramp)
        write_png(self.path("actual.png"), width, height, lambda x, y: actual(x, y, ramp(x, y)))
        return self.run_program("expected.png", "actual.png", "difference.png",
                                program=os.path.join(BINARY, "golden_compare"))

    def passes(self, actual):
        done = self.compare(actual)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertFalse(os.path.exists(self.path("difference.png")))

    def fails(self, actual):
        done = self.compare(actual)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("difference.png", done.stdout)
        return Png(self.read("difference.png"))

    def test_equal_pictures_pass(self):
        self.passes(lambda x, y, c: c)

    def test_rounding_passes(self):
        self.passes(lambda x, y, c: tuple(v + ((x * 3 + y * 5) % 31 == 0) for v in c))

    def test_a_wrong_edge_passes(self):
        self.passes(lambda x, y, c: (255, 255, 255) if (x, y) == (3, 3) else c)

    def test_a_brighter_picture_fails(self):
        self.fails(lambda x, y, c: tuple(v + 1 for v in c))

    def test_a_missing_wisp_fails(self):
        self.fails(lambda x, y, c: tuple(v + 20 for v in c) if 8 <= x < 14 and 8 <= y < 14 else c)

    def test_the_last_block_counts(self):
        self.fails(lambda x, y, c: (255, 255, 255) if x >= 156 and y >= 76 else c)

    def test_difference_is_shown_beside_the_pictures(self):
        shown = self.fails(lambda x, y, c: tuple(v + 5 for v in c))
        self.assertEqual((shown.width, shown.height), (480, 80))
        self.assertEqual(shown.rows[3][:3], (0, 6, 100))
        self.assertEqual(shown.rows[3][480:483], (5, 11, 105))
        self.assertEqual(shown.rows[3][960:963], (40, 40, 40))

    def test_another_size_fails(self):
        done = self.compare(lambda x, y, c: c, width=159)
        self.assertEqual(done.returncode, 1)
        self.assertIn("159 x 80", done.stderr)

    def test_a_missing_picture_fails(self):
        done = self.run_program("a.png", "b.png", "c.png", program=os.path.join(BINARY, "golden_compare"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("a.png", done.stderr)


if __name__ == "__main__":
    main()
