"""Of side_by_side.py, what can be wrong without being seen in a table."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import side_by_side as bench


class Planes(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.file = pathlib.Path(scratch.name) / "planes.txt"

    def test_are_read_as_they_were_written(self):
        planes = [bench.Plane("a", [0.1, 2, 3, 4, 5, 3, 7, 8, 9]),
                  bench.Plane("b", [1 / 3, 2, 3, 4, 5, 6, 7, 8, -9e-7])]
        read = bench.read_planes(bench.write_planes(self.file, planes))
        self.assertEqual([(p.name, p.numbers) for p in read],
                         [(p.name, p.numbers) for p in planes])

    def test_know_whether_their_rows_lie_in_layers(self):
        self.file.write_text("# x\n\nin 0 0 3 9 9 3 1 1 8\nacross 0 0 3 9 9 4 1 1 8\n",
                             encoding="utf-8")
        self.assertEqual([p.rows_in_layers for p in bench.read_planes(self.file)], [True, False])

    def test_that_are_not_nine_numbers_are_refused_by_line(self):
        for line in ("a 1 2 3", "a 1 2 3 4 5 6 7 8 9 10", "a 1 2 3 4 x 6 7 8 9"):
            self.file.write_text(f"# first\n{line}\n", encoding="utf-8")
            with self.assertRaisesRegex(bench.Failure, "line 2"):
                bench.read_planes(self.file)

    def test_of_this_folder_can_be_read(self):
        for name in ("planes.txt", "scale_planes.txt"):
            self.assertGreater(len(bench.read_planes(bench.FOLDER / name)), 2)


class Figures(unittest.TestCase):
    def test_are_medians_with_least_and_most(self):
        self.assertEqual(bench.Spread([0.4, 0.1, 0.2]).text(10, 1), "2.0 (1.0–4.0)")
        self.assertEqual(bench.Spread([0.4]).text(), "0.40")

    def test_are_divided_round_by_round(self):
        self.assertEqual(bench.ratios([1, 9, 2], [2, 3, 2]).values, [0.5, 3.0, 1.0])

    def test_have_a_geometric_mean(self):
        self.assertAlmostEqual(bench.geometric_mean([0.5, 2, 8]), 2)

    def test_meet_their_goal_or_miss_it(self):
        self.assertIn("**met**", bench.goal("x", 1.1, 1.1))
        self.assertIn("**missed**", bench.goal("x", 1.11, 1.1))


class Programs(unittest.TestCase):
    def test_that_fail_are_told_by_their_last_words(self):
        with self.assertRaisesRegex(bench.Failure, "ended with 3: because"):
            bench.run(["sh", "-c", "echo first >&2; echo because >&2; exit 3"])

    def test_that_are_not_built_are_named(self):
        with self.assertRaisesRegex(bench.Failure, "no_such_program is not there"):
            bench.built("no_such_program")


class PageCache(unittest.TestCase):
    def test_forgets_a_samples_files_without_root(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "shard").write_bytes(bytes(1 << 20))
            cache = bench.PageCache()
            cache.all_of_it = False
            cache.forget(folder)
            self.assertIn("not root", cache.describe())


if __name__ == "__main__":
    unittest.main()
