"""Calls that their callers or their deadlines end: the server has all that they took again. How soon
is measured by tests/promises/cancel."""

import contextlib
import unittest

import grpc
import numpy as np

import server_process
from durable_case import example
from interrupted import Call, Status, interrupt

# Seconds of work for one thread, most of it in the graph.
NOISE = np.random.default_rng(1).random((2, 100, 100, 100)) < 0.45
SOON_S = 0.5


def requests():
    return list(example.requests(NOISE))


class CancelTest(unittest.TestCase):
    def setUp(self):
        with contextlib.ExitStack() as stack:
            self.server = stack.enter_context(server_process.ServerProcess(
                "--threads", "1", "--max-jobs", "1", "--metrics-listen", "127.0.0.1:0"))
            self.page = self.server.line_after("metrics at ")
            self.channel = stack.enter_context(grpc.insecure_channel(self.server.address))
            self.status = stack.enter_context(Status(self.server.address))
            self.addCleanup(stack.pop_all().close)

    def is_at_work(self):
        return self.status.now().busy_threads > 0

    def ends(self, call, way, is_free=None):
        self.assertIsNotNone(interrupt(call, way, SOON_S, self.status, is_free or
                                       self.status.is_idle))

    def jobs(self, *codes):
        """How many jobs ended so, as the metrics have it."""
        found = server_process.metrics(self.page).items()
        return sum(float(value) for name, value in found
                   if name.startswith("bccskel_jobs_total") and
                   any(f'code="{code}"' in name for code in codes))

    def both_ways(self, begin, is_free=None):
        """`begin` makes a call with a timeout."""
        self.ends(begin(server_process.TIMEOUT_S), "cancel", is_free)
        self.ends(begin(SOON_S), "deadline", is_free)
        # The end of a call whose deadline has passed may come to the server as its cancelling.
        self.assertEqual((self.jobs("CANCELLED", "DEADLINE_EXCEEDED"), self.jobs("OK")), (2, 0))

    def test_while_the_volume_comes(self):
        self.both_ways(lambda timeout: Call(self.channel, requests()[:2], timeout, stops=True))

    def test_while_another_job_has_the_place(self):
        other = Call(self.channel, requests())
        self.status.wait_until(self.is_at_work)
        self.both_ways(lambda timeout: Call(self.channel, requests(), timeout),
                       self.status.waits_for_none)
        self.assertFalse(other.is_over())
        self.ends(other, "cancel")

    def test_while_it_computes(self):
        self.both_ways(lambda timeout: Call(self.channel, requests(), timeout))


if __name__ == "__main__":
    unittest.main()
