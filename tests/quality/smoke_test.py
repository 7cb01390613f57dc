"""Runs every study once, tiny, and makes the report of it.

Usage: smoke_test.py BCCSKEL_QUALITY
"""

import json
import subprocess
import sys
import unittest

import tables
import wild_tables

STUDIES = {"figures": [], "rotations": [], "reconstruction": [],
           "spine-lengths": [], "thick-slices": [], "cut-limbs": [], "image-faces": [],
           "wild": ["--as", "bcc,mask", "--noise", "0,5", "--half", "judge", "--json"]}

MASKS = [{"mask": f"{kind}.nrrd", "kind": kind, "voxels": 1000, "components": 1, "loops": 2, "ends": 3,
          "twigs": 0, "redundant_length": 0.25, "missed": 1, "branches": 5, "seconds": 0.1}
         for kind in ("neuron", "vessels", "airway", "scan")]


class SmokeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rows = {}
        for study, more in STUDIES.items():
            text = subprocess.run([PROGRAM, study, "--points", "3000", "--turns", "1", *more],
                                  check=True, stdout=subprocess.PIPE).stdout
            cls.rows[study] = [json.loads(line) for line in text.splitlines()]

    def test_every_study_has_rows_of_every_figure(self):
        names = {row["figure"] for row in self.rows["figures"]}
        self.assertGreaterEqual(len(names), 16)
        self.assertEqual({row["figure"] for row in self.rows["reconstruction"]}, names)
        self.assertLessEqual({row["figure"] for row in self.rows["rotations"]}, names)

    def test_wild_figures_come_as_both_kinds_of_objects_in_every_class(self):
        classes = [{row["class"] for row in self.rows["wild"] if row["as"] == kind}
                   for kind in ("bcc", "mask")]
        self.assertEqual(classes[0], classes[1])
        self.assertGreaterEqual(len(classes[0]), 19)
        for row in self.rows["wild"]:
            self.assertLess(abs(row["tips"] - row["lost"] + row["spurious"] - row["ends"]),
                            1 if row["known"] else 1000, row)

    def test_skeletons_are_thin_and_keep_the_loops_of_their_figures(self):
        for row in self.rows["figures"]:
            if row["method"] == tables.DENOISED:
                continue
            self.assertEqual(row["simple_left"], 0, row)
            self.assertEqual(row["loops_found"], row["loops"], row)

    def test_tubes_have_two_ends_however_thick_the_slices_are(self):
        for row in self.rows["thick-slices"]:
            self.assertEqual(row["wrong"], 0, row)

    def test_limbs_that_the_border_cuts_have_two_ends_at_their_cuts(self):
        for row in self.rows["cut-limbs"]:
            self.assertEqual(row["wrong"], 0, row)
            self.assertLess(row["gap"], 0.6, row)

    def test_limbs_that_cross_others_before_the_border_have_ends_there_by_default(self):
        found = {border: sum(row["found"] for row in self.rows["image-faces"]
                             if row["border"] == border and row["what"] == "crossing limbs")
                 for border in ("ends", "auto")}
        self.assertGreater(found["auto"], found["ends"])
        tight = {row["border"]: row["changed"] for row in self.rows["image-faces"]
                 if row["what"] == "tight crops"}
        self.assertLessEqual(tight["auto"], tight["ends"] + 1)

    def test_the_report_has_all_its_tables(self):
        text = "\n".join(tables.report(self.rows["figures"], [], self.rows["rotations"],
                                       self.rows["reconstruction"], [],
                                       wild_tables.report(self.rows["wild"],
                                                          self.rows["spine-lengths"],
                                                          self.rows["thick-slices"],
                                                          self.rows["cut-limbs"],
                                                          self.rows["image-faces"], [], MASKS, [],
                                                          {words: MASKS for words in
                                                           wild_tables.MASK_OPTIONS})))
        for title in ("Targets", "Against known center lines", "Figure by figure", "Turning",
                      "Thinness", "Reconstruction", "Targets in the wild", "Figures in the wild",
                      "Thick slices", "Limbs that the border cuts",
                      "Images that cut many limbs", "Real masks", "Options for real masks"):
            self.assertIn(f"## {title}", text)
        self.assertNotIn("nan", text)

    def test_a_study_that_does_not_exist_is_refused(self):
        ended = subprocess.run([PROGRAM, "astrology"], stderr=subprocess.PIPE,
                               check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(b"astrology", ended.stderr)

    def test_an_option_that_does_not_exist_is_refused(self):
        ended = subprocess.run([PROGRAM, "wild", "--moon", "3"], stderr=subprocess.PIPE,
                               check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(b"--moon", ended.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
