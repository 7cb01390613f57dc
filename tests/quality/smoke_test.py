"""Runs every study once, tiny, and makes the report of it.

Usage: smoke_test.py BCCSKEL_QUALITY
"""

import json
import subprocess
import sys
import unittest

import tables

STUDIES = ("figures", "masks", "rotations", "reconstruction")


class SmokeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rows = {}
        for study in STUDIES:
            text = subprocess.run([PROGRAM, study, "3000", "1"], check=True,
                                  stdout=subprocess.PIPE).stdout
            cls.rows[study] = [json.loads(line) for line in text.splitlines()]

    def test_every_study_has_rows_of_every_figure(self):
        names = {row["figure"] for row in self.rows["figures"]}
        self.assertGreaterEqual(len(names), 16)
        self.assertEqual({row["figure"] for row in self.rows["reconstruction"]}, names)
        for study in ("masks", "rotations"):
            self.assertLessEqual({row["figure"] for row in self.rows[study]}, names)

    def test_skeletons_are_thin_and_keep_the_loops_of_their_figures(self):
        for row in self.rows["figures"]:
            if row["method"] == tables.DENOISED:
                continue
            self.assertEqual(row["simple_left"], 0, row)
            self.assertEqual(row["loops_found"], row["loops"], row)

    def test_the_report_has_all_its_tables(self):
        text = "\n".join(tables.report(self.rows["figures"], [], self.rows["rotations"],
                                       self.rows["reconstruction"], self.rows["masks"], []))
        for title in ("Targets", "Against known center lines", "Figure by figure", "Turning",
                      "Thinness", "Reconstruction", "Voxels"):
            self.assertIn(f"## {title}", text)
        self.assertNotIn("nan", text)

    def test_a_study_that_does_not_exist_is_refused(self):
        ended = subprocess.run([PROGRAM, "astrology", "3000", "1"], stderr=subprocess.PIPE,
                               check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(b"astrology", ended.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
