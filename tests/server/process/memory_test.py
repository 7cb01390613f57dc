"""Objects made to take memory: whatever a volume holds, the process stays within its limit plus
64 MiB, the job ends well or with a reason, and the server goes on."""

import concurrent.futures
import unittest

import grpc
import numpy as np

from durable_case import DurableTest
from interface import durable, example, jobs, labels_example
from server_process import ServerProcess

LIMIT = 500_000_000
MARGIN = 64 << 20
FLAGS = ("--max-memory-bytes", str(LIMIT), "--threads", "2")
GOOD = np.ones((2, 4, 4, 4), dtype=bool)


def isolated_points(cells=(384, 96, 192)):
    """Every second point of one sublattice: as a file 162 bytes."""
    i, j, k = np.indices(cells, sparse=True)
    even = (i + j + k) % 2 == 0
    return np.stack([even, np.zeros_like(even)])


def checkerboard(size):
    z, y, x = np.indices((size,) * 3, sparse=True)
    return (x + y + z) % 2 == 0


def net(step, cells=(256, 128, 128)):
    """Bars along all axes, a point thick."""
    i, j, k = np.indices(cells, sparse=True)
    bars = (i % step == 0).astype(int) + (j % step == 0) + (k % step == 0) >= 2
    return np.stack([bars, np.zeros_like(bars)])


def noise(share, *shape):
    return np.random.default_rng(7).random(shape) < share


VOLUMES = {
    "isolated points": isolated_points,
    "checkerboard mask": lambda: checkerboard(96),
    "large checkerboard mask": lambda: checkerboard(192),
    "net": lambda: net(2),
    "wide net": lambda: net(4),
    "noise": lambda: noise(0.3, 2, 128, 128, 128),
    "noise mask": lambda: noise(0.2, 160, 160, 160),
}


class MemoryTest(unittest.TestCase):
    def setUp(self):
        self.server = ServerProcess(*FLAGS)
        self.addCleanup(self.server.__exit__)
        self.channel = grpc.insecure_channel(self.server.address)
        self.addCleanup(self.channel.close)

    def ends(self, call):
        """True where the call has a result, false where it was refused with a reason."""
        try:
            call()
        except grpc.RpcError as error:
            self.assertEqual(error.code(), grpc.StatusCode.RESOURCE_EXHAUSTED, error.details())
            self.assertIn("bytes", error.details())
            return False
        return True

    def stays_within(self):
        self.assertLessEqual(self.server.peak_bytes(), LIMIT + MARGIN)
        # What is refused takes nothing from what follows.
        self.assertTrue(example.skeletonize(self.channel, GOOD).summary.sha256)

    def test_each_volume_alone(self):
        for name, make in VOLUMES.items():
            with self.subTest(name):
                self.ends(lambda: example.skeletonize(self.channel, make()))
                self.stays_within()

    def test_many_at_once(self):
        arrays = [make() for make in VOLUMES.values()]
        with concurrent.futures.ThreadPoolExecutor(8) as callers:
            list(callers.map(self.ends_or_waits, arrays))
        self.stays_within()

    def ends_or_waits(self, array):
        """Memory that other jobs have now may also be told as UNAVAILABLE."""
        try:
            example.skeletonize(self.channel, array)
        except grpc.RpcError as error:
            self.assertIn(error.code(), (grpc.StatusCode.RESOURCE_EXHAUSTED,
                                         grpc.StatusCode.UNAVAILABLE), error.details())

    def test_labels_of_isolated_voxels(self):
        board = checkerboard(96)
        for name, image in {
                "one label": board.astype(np.uint8),
                "many labels": board * (np.arange(board.size).reshape(board.shape) % 1000 + 1),
        }.items():
            with self.subTest(name):
                self.ends(lambda: dict(labels_example.skeletonize_labels(
                    self.channel, image.astype(np.uint16))))
                self.stays_within()


class DurableMemoryTest(DurableTest):
    def test_a_job_that_needs_too_much_is_tried_once(self):
        server = self.start(*FLAGS[:2])
        declaration, data = example.declare(checkerboard(192), 1.0, (0, 0, 0), np.eye(3))
        job = self.create(durable.send_volume(self.channel, declaration, data)).name
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_FAILED)
        self.assertEqual(self.get(job).attempts, 1)
        self.assertLessEqual(server.peak_bytes(), LIMIT + MARGIN)


if __name__ == "__main__":
    unittest.main()
