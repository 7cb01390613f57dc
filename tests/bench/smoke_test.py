"""Runs every benchmark once at the smallest size and checks what the report relies on.

Usage: smoke_test.py REFERENCE_DIGEST CUBIC_OBJECT BCCSKEL
"""

import itertools
import json
import re
import subprocess
import sys
import unittest

OBJECTS = ["ball", "torus", "horse", "blob", "tubes", "tree", "thin-tubes"]
POINTS = 10000
STAGES = {"preparing", "distance", "shells", "thinning", "cleanup", "pruning", "certificate", "graph"}
SPREAD = {"min", "median", "max"}


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def reference_digest(name):
    return output_of(REFERENCE, name, str(POINTS)).decode().strip()


class SmokeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reference = {name: reference_digest(name) for name in OBJECTS}

    def test_the_command_prints_the_promised_keys_and_the_references_skeleton(self):
        described = output_of(COMMAND, "bench", "core", "--help").decode()
        sets = re.search(r"--isa (\S+)", described).group(1).split("|")
        for name, threads, isa in itertools.product(OBJECTS, (1, 2), sets):
            with self.subTest(name, threads=threads, isa=isa):
                result = json.loads(output_of(
                    COMMAND, "bench", "core", "--shape", name, "--points", str(POINTS),
                    "--threads", str(threads), "--isa", isa, "--repeat", "2", "--json"))
                self.assertLessEqual(
                    {"method", "isa", "threads", "points", "ns_per_point", "whole_ns_per_point",
                     "stages", "peak_bytes", "sha256"}, result.keys())
                for spread in (result["ns_per_point"], result["whole_ns_per_point"],
                               *result["stages"].values()):
                    self.assertEqual(spread.keys(), SPREAD)
                    self.assertLessEqual(spread["min"], spread["median"])
                    self.assertLessEqual(spread["median"], spread["max"])
                self.assertEqual(result["method"], "directional")
                self.assertEqual((result["threads"], result["isa"]), (threads, isa))
                self.assertEqual(result["stages"].keys(), STAGES)
                self.assertAlmostEqual(result["points"] / POINTS, 1, delta=0.03)
                for time in SPREAD:
                    self.assertLess(result["ns_per_point"][time],
                                    result["whole_ns_per_point"][time])
                self.assertEqual(result["sha256"], self.reference[name])

    def test_each_method_makes_a_skeleton_of_its_own(self):
        digests = set()
        for method in ("directional", "directional-alternating", "symmetric"):
            result = json.loads(output_of(
                COMMAND, "bench", "core", "--shape", "horse", "--points", str(POINTS),
                "--method", method, "--repeat", "1", "--json"))
            self.assertEqual(result["method"], method)
            digests.add(result["sha256"])
        self.assertEqual(len(digests), 3)

    def test_the_command_refuses_what_does_not_exist(self):
        for option, value in (("--method", "sideways"), ("--isa", "abacus"),
                              ("--shape", "teapot"), ("--points", "3"), ("--repeat", "0")):
            with self.subTest(option):
                ended = subprocess.run([COMMAND, "bench", "core", option, value],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
                self.assertEqual(ended.returncode, 2)
                self.assertIn(value, ended.stderr.decode())
                self.assertEqual(ended.stdout, b"")

    def test_a_cubic_object_has_the_wanted_number_of_voxels(self):
        header, bits = output_of(CUBIC, "tubes", str(POINTS)).split(b"\n", 1)
        nx, ny, nz, voxels = (int(word) for word in header.split())
        self.assertEqual(len(bits), (nx * ny * nz + 7) // 8)
        self.assertEqual(sum(bin(byte).count("1") for byte in bits), voxels)
        self.assertAlmostEqual(voxels / POINTS, 1, delta=0.05)


if __name__ == "__main__":
    REFERENCE, CUBIC, COMMAND = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
