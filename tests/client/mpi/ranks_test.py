"""Runs bccskel-mpi under mpirun: the results of one machine, refusals, lost ranks, interrupts."""

import contextlib
import json
import os
import pathlib
import signal
import struct
import subprocess
import tempfile
import time
import unittest

CLIENT = os.environ["BCCSKEL"]
RANKS = os.environ["BCCSKEL_MPI"]
MPIRUN = os.environ["BCCSKEL_MPIRUN"]
DATA = pathlib.Path(os.environ.get("BCCSKEL_TEST_DATA", ""))
# Containers run tests as root and have few processors.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
HANGS = 120  # seconds, after which a job that should have ended is taken to hang


def words_of(ranks, words):
    return [MPIRUN, "--oversubscribe", "-n", str(ranks), RANKS, *map(str, words)]


def run_ranks(ranks, *words):
    return subprocess.run(words_of(ranks, words), env=ENVIRONMENT, capture_output=True, text=True,
                          timeout=HANGS)


def ranks_of(job):
    children = pathlib.Path(f"/proc/{job.pid}/task/{job.pid}/children").read_text().split()
    return [int(pid) for pid in children
            if pathlib.Path(f"/proc/{pid}/comm").read_text().startswith("bccskel-mpi")]


def kill_at_once(job):
    """With its ranks, which otherwise go on for a while and write into their folder."""
    ranks = ranks_of(job)
    job.kill()
    for rank in ranks:
        with contextlib.suppress(ProcessLookupError):
            os.kill(rank, signal.SIGKILL)
    end = time.monotonic() + HANGS
    while any(runs(rank) for rank in ranks) and time.monotonic() < end:
        time.sleep(0.02)


def runs(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_bytes() != b""  # empty: a zombie
    except FileNotFoundError:
        return False


def generate(folder, shape, points, ending=".exr"):
    path = pathlib.Path(folder) / f"{shape}{points}{ending}"
    bccskel("generate", shape, "--points", points, "--noise", "0.02", "-o", path)
    return path


def bccskel(*words):
    subprocess.run([CLIENT, *map(str, words)], capture_output=True, text=True, check=True,
                   timeout=HANGS)


def result_of(path):
    """A result without what no two runs share."""
    result = json.loads(pathlib.Path(path).read_text())
    del result["timings"]
    return result


def plain_bricks():
    """A bricks file without compression: a thick ring of two sublattices in 60 x 60 x 40 cells."""
    words = {}
    for odd in (0, 1):
        for k in range(40):
            for j in range(60):
                for i in range(60):
                    x, y, z = i - 30 + odd / 2, j - 30 + odd / 2, k - 20 + odd / 2
                    if ((x * x + y * y) ** 0.5 - 20) ** 2 + z * z >= 49:
                        continue
                    brick = words.setdefault((k // 8, j // 4, i // 16, odd), [0] * 8)
                    brick[k % 8] |= 1 << (16 * (j % 4) + i % 16)
    header = b"BCCB\r\n\x1a\n" + struct.pack("<II3iIQ", 1, 0, 60, 60, 40, 0, len(words))
    header += struct.pack("<15d", 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
    records = [struct.pack("<3iI8Q", bx, by, bz, odd, *bits)
               for (bz, by, bx, odd), bits in sorted(words.items())]
    return header + b"".join(records)


class TestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def generate(self, shape, points, ending=".exr"):
        return generate(self.folder, shape, points, ending)


class Results(TestCase):
    def expect_same(self, source, *options, ranks):
        wanted = self.folder / "wanted.json"
        bccskel("skeletonize", "--local", source, "-o", wanted, *options)
        for count in ranks:
            with self.subTest(source=source.name, ranks=count, options=options):
                got = self.folder / f"got{count}.json"
                run = run_ranks(count, "skeletonize", source, "-o", got, *options)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(result_of(got), result_of(wanted))

    def test_volumes(self):
        self.expect_same(self.generate("blob", 60_000), ranks=(1, 2, 8))
        self.expect_same(self.generate("tree", 30_000, ".bccb"), "--method", "directional",
                         ranks=(3, 5))

    def test_threads_of_ranks(self):
        self.expect_same(self.generate("torus", 400_000), "--threads", "2", ranks=(2, 3))

    def test_chamfer_distances(self):
        self.expect_same(self.generate("horse", 60_000), "--distance", "chamfer", ranks=(3, 8))
        self.expect_same(self.generate("tubes", 60_000), "--distance", "chamfer", "--method",
                         "directional", ranks=(2, 5))

    def test_meshes_and_masks(self):
        if not DATA.joinpath("mesh/elephant.off").exists():
            self.skipTest("there are no reference models")
        self.expect_same(DATA / "mesh/elephant.off", ranks=(2, 5))
        self.expect_same(DATA / "volume/neuron_28018323.nrrd", "--border", "ends", ranks=(2, 5))

    def test_parts_of_files(self):
        bricks = self.generate("tree", 60_000, ".bccb")
        plain = self.folder / "plain.bccb"
        plain.write_bytes(plain_bricks())
        self.expect_same(plain, ranks=(2, 3, 8))
        self.expect_same(bricks, "--fill-cavities", ranks=(3,))

    def test_parts_of_masks(self):
        mask = self.folder / "mask.raw"
        values = [(x - 20) ** 2 + (y - 15) ** 2 + (z - 30) ** 2 < 180 or (x * 7 + y * 5 + z * 3) % 97 == 0
                  for z in range(60) for y in range(30) for x in range(40)]
        mask.write_bytes(bytes(map(int, values)))
        raw = ("--raw-size", "40,30,60")
        self.expect_same(mask, *raw, ranks=(2, 5))
        self.expect_same(mask, *raw, "--adjacency", "6,26", ranks=(3,))
        self.expect_same(mask, *raw, "--voxel-points", "16", ranks=(3,))
        self.expect_same(mask, *raw, "--sampling", "trilinear", ranks=(3,))

    def test_shapes_that_ranks_generate(self):
        for shape, noise in (("ball", "0"), ("tree", "0.02")):
            source = self.folder / f"{shape}.bccb"
            bccskel("generate", shape, "--points", 50_000, "--seed", 4, "--noise", noise, "-o", source)
            wanted = self.folder / "wanted.json"
            bccskel("skeletonize", "--local", source, "-o", wanted)
            for count in (1, 3, 8):
                got = self.folder / "got.json"
                run = run_ranks(count, "skeletonize", "--generate", shape, "--points", 50_000,
                                "--seed", 4, "--noise", noise, "-o", got)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual(result_of(got), result_of(wanted))

    def test_other_formats(self):
        source = self.generate("knot", 30_000)
        for ending in (".swc", ".vtp", ".obj"):
            wanted, got = self.folder / f"wanted{ending}", self.folder / f"got{ending}"
            bccskel("skeletonize", "--local", source, "-o", wanted)
            run = run_ranks(3, "skeletonize", source, "-o", got)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(got.read_bytes(), wanted.read_bytes())


class Reports(TestCase):
    def test_what_each_rank_sent(self):
        run = run_ranks(2, "skeletonize", self.generate("ball", 20_000), "-o",
                        self.folder / "out.json", "--report-exchange")
        self.assertEqual(run.returncode, 0, run.stderr)
        for rank in (0, 1):
            self.assertRegex(run.stderr, rf"bccskel-mpi: rank {rank} of 2: thinning: [0-9]+ trades, "
                             "[0-9]+ sums, [1-9][0-9]* messages, [1-9][0-9]* bytes sent, ")


class Refusals(TestCase):
    def expect_refused(self, code, told, *words):
        run = run_ranks(3, *words)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stderr.count("bccskel-mpi: error:"), 1, run.stderr)
        self.assertNotIn("bccskel: ", run.stderr)
        self.assertIn(told, run.stderr)

    def test_what_ranks_cannot_do(self):
        source = self.generate("ball", 20_000)
        out = self.folder / "out.json"
        self.expect_refused(2, "--border", "skeletonize", source, "-o", out, "--border",
                            "continues")
        self.expect_refused(2, "bccskel view", "skeletonize", source, "-o",
                            self.folder / "out.html")
        self.expect_refused(2, "--server", "skeletonize", source, "-o", out, "--server",
                            "localhost:1")
        self.expect_refused(2, "skeletonize", "info", source)
        self.expect_refused(2, "bccskel-mpi skeletonize INPUT")
        self.expect_refused(2, f"takes the place of INPUT: omit {source}", "skeletonize", source,
                            "-o", out, "--generate", "ball")
        self.expect_refused(2, "--checkpoint FOLDER", "skeletonize", source, "-o", out, "--resume")

    def test_version_and_help(self):
        self.assertRegex(run_ranks(1, "--version").stdout, r"^bccskel-mpi [0-9.]+\n$")
        self.assertIn("--swc-step", run_ranks(1, "--help").stdout)

    def test_options_that_are_none(self):
        self.expect_refused(2, "bccskel-mpi: hint: see bccskel-mpi skeletonize --help",
                            "skeletonize", "a.exr", "-o", "a.swc", "--pints", 9)

    def test_input_that_is_not_there(self):
        self.expect_refused(3, "nothing.exr", "skeletonize", self.folder / "nothing.exr", "-o",
                            self.folder / "out.json")

    def test_shapes_that_are_none(self):
        out = self.folder / "out.json"
        self.expect_refused(2, "the command is missing", "--generate", "ball")
        self.expect_refused(2, "no shape is named", "skeletonize", "--generate", "bal", "-o", out)
        self.expect_refused(3, "must be", "skeletonize", "--generate", "ball", "--points", 7, "-o",
                            out)

    def test_bricks_that_are_there_twice(self):
        plain = self.folder / "plain.bccb"
        data = plain_bricks()
        plain.write_bytes(data[:-80] + data[160:240])  # the first brick again, in the last part
        self.expect_refused(3, "given twice", "skeletonize", plain, "-o", self.folder / "out.json")

    def test_output_that_cannot_be_written(self):
        self.expect_refused(8, "no/such", "skeletonize", self.generate("ball", 20_000), "-o",
                            self.folder / "no/such/out.json")

    def test_too_little_time(self):
        self.expect_refused(5, "--timeout", "skeletonize", self.generate("ball", 400_000), "-o",
                            self.folder / "out.json", "--timeout", "0.001")


class Checkpoints(TestCase):
    def test_a_job_that_was_killed_is_resumed_on_other_ranks(self):
        source = self.generate("ball", 1_000_000)
        wanted, got = self.folder / "wanted.json", self.folder / "got.json"
        bccskel("skeletonize", "--local", source, "-o", wanted)
        folder = self.folder / "shells"
        words = ("skeletonize", source, "-o", got, "--checkpoint", folder, "--checkpoint-every",
                 "0", "--resume", "--progress", "always")
        with subprocess.Popen(words_of(3, words), env=ENVIRONMENT, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True) as job:
            for line in job.stdout:
                if "shell 9/" in line:
                    break
            kill_at_once(job)
        self.assertTrue((folder / "checkpoint").exists())
        run = run_ranks(2, *words)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("shell 3/", run.stderr)
        self.assertEqual(result_of(got), result_of(wanted))

    def test_a_checkpoint_of_another_object_or_a_damaged_one_is_refused(self):
        folder = self.folder / "shells"
        options = ("-o", self.folder / "out.json", "--checkpoint", folder, "--checkpoint-every",
                   "0", "--resume")
        run = run_ranks(2, "skeletonize", self.generate("ball", 20_000), *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        run = run_ranks(2, "skeletonize", self.generate("torus", 20_000), *options)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("another object", run.stderr)
        (folder / "checkpoint").write_bytes(b"damaged")
        run = run_ranks(2, "skeletonize", self.folder / "ball20000.exr", *options)
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("checkpoint is damaged", run.stderr)


class Ends(TestCase):
    """Of a job in the middle of its shells."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.source = generate(folder.name, "ball", 20_000_000)

    def start(self):
        self.output = self.folder / "out.json"
        with open(self.folder / "log", "w", encoding="utf-8") as log:
            job = subprocess.Popen(
                words_of(3, ("skeletonize", self.source, "-o", self.output, "--progress", "always")),
                env=ENVIRONMENT, stdout=log, stderr=log)
        self.addCleanup(job.wait, HANGS)
        self.addCleanup(job.kill)
        self.wait_for(lambda: "shell 3/" in self.log(), job)
        return job

    def log(self):
        return (self.folder / "log").read_text()

    def wait_for(self, condition, job):
        end = time.monotonic() + HANGS
        while not condition():
            self.assertIsNone(job.poll(), self.log())
            self.assertLess(time.monotonic(), end, self.log())
            time.sleep(0.02)

    def test_a_rank_that_is_killed_ends_the_job(self):
        job = self.start()
        os.kill(ranks_of(job)[-1], signal.SIGKILL)
        self.assertNotEqual(job.wait(timeout=30), 0)
        self.assertIn("signal 9", self.log())
        self.assertFalse(self.output.exists())

    def test_an_interrupt_ends_the_job(self):
        job = self.start()
        job.send_signal(signal.SIGINT)
        self.assertNotEqual(job.wait(timeout=30), 0)
        self.assertFalse(self.output.exists())


if __name__ == "__main__":
    unittest.main()
