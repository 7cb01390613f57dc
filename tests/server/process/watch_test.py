"""Streams of a server with a data directory: heartbeats, and callers who read slowly or not at all."""

import os
import unittest

import grpc
import numpy as np

from durable_case import DurableTest, large_requests, large_volume
from interface import (HeldBack, durable, example, jobs, options_pb2 as options, service_grpc,
                       shell_width, torus_loops)
from server_process import ServerProcess

from bccskel.v1 import server_service_pb2 as capabilities  # in the stubs
from bccskel.v1 import server_service_pb2_grpc as capabilities_grpc

# A sanitized server would keep 256 MiB of freed memory, to see who still uses it.
os.environ.setdefault("ASAN_OPTIONS", "quarantine_size_mb=1")

MIB = 1 << 20
HOUR_S = 3600


class CapabilitiesTest(DurableTest):
    def durability(self, channel):
        return capabilities_grpc.ServerServiceStub(channel).GetCapabilities(
            capabilities.GetCapabilitiesRequest()).durability

    def test_they_say_whether_the_server_keeps_anything_and_how_long(self):
        self.start("--keep-volumes", "2", "--max-disk-bytes", "1GB")
        found = self.durability(self.channel)
        self.assertTrue(found.durable)
        self.assertEqual((found.keep_uploads.seconds, found.keep_volumes.seconds,
                          found.keep_jobs.seconds), (24 * HOUR_S, 2 * HOUR_S, 168 * HOUR_S))
        self.assertEqual((found.max_disk_bytes, found.max_tenant_disk_bytes), (1 << 30, 0))
        self.assertGreater(found.max_unfinished_jobs, 0)
        with ServerProcess() as server, grpc.insecure_channel(server.address) as channel:
            self.assertEqual(self.durability(channel), capabilities.Durability())


class HeartbeatTest(DurableTest):
    def test_a_job_to_which_nothing_happens_sends_heartbeats(self):
        self.start()
        requests = HeldBack(large_requests())
        replies = service_grpc.SkeletonizationServiceStub(self.channel).Skeletonize(iter(requests))
        job = next(replies).accepted.job
        events = self.jobs.WatchJob(jobs.WatchJobRequest(job=job))
        first = next(events)
        self.assertEqual(first.state_change.state, jobs.JOB_STATE_RECEIVING)
        second = next(events)
        self.assertTrue(second.HasField("heartbeat"))
        self.assertEqual(second.sequence, first.sequence)
        self.assertGreaterEqual(second.time.ToSeconds() - first.time.ToSeconds(), 9)
        self.jobs.CancelJob(jobs.CancelJobRequest(job=job))
        self.assertEqual([event.state_change.state for event in events],
                         [jobs.JOB_STATE_CANCELLED])
        requests.let_go()


def thicket():
    """A volume whose skeleton takes megabytes: noise, of which nothing is pruned."""
    cells = np.random.default_rng(1).random((2, 64, 64, 64)) < 0.45
    return example.declare(cells, 1.0, (0, 0, 0), np.eye(3))


AS_THINNED = options.SkeletonizeOptions(
    pruning_rule=options.PRUNING_RULE_NONE, tip_placement=options.TIP_PLACEMENT_AS_THINNED,
    stubble_policy=options.STUBBLE_POLICY_NONE)


class SlowReaderTest(DurableTest):
    READERS = 40

    def test_results_that_are_not_read_cost_little_memory_and_hold_nobody_up(self):
        server = self.start()
        name = durable.send_volume(self.channel, *thicket())
        job = self.create(name, options=AS_THINNED).name
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        size = self.get(job).result_bytes
        server.forget_peak()
        before = server.peak_bytes()
        slow = [self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=job))
                for _ in range(self.READERS)]
        first = [next(pieces) for pieces in slow]
        # Others go on meanwhile, also on the same connection.
        whole = list(self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=job)))
        self.assertEqual(torus_loops(self.channel), 1)
        grown = server.peak_bytes() - before
        print(f"{self.READERS} readers stopped after {first[0].ByteSize()} of {size} bytes: "
              f"the server grew by {grown / MIB:.1f} MiB")
        self.assertGreater(size, 2 * MIB)
        self.assertLess(grown, self.READERS * size / 2)
        for piece, rest in list(zip(first, slow))[::10]:
            self.assertEqual([piece, *rest], whole)

    def test_watches_that_are_not_read_hold_nobody_up_and_lose_no_state(self):
        server = self.start()
        name = durable.send_volume(self.channel, *large_volume())
        server.forget_peak()
        before = server.peak_bytes()
        job = self.create(name, options=shell_width(0.75)).name
        unread = [self.jobs.WatchJob(jobs.WatchJobRequest(job=job)) for _ in range(self.READERS)]
        states = self.finish(job)
        self.assertEqual(states[-1], jobs.JOB_STATE_SUCCEEDED)
        print(f"{self.READERS} watches unread: the server grew by "
              f"{(server.peak_bytes() - before) / MIB:.1f} MiB, the job included")
        for watch in unread:
            events = list(watch)
            sequences = [event.sequence for event in events]
            self.assertEqual(sequences, sorted(set(sequences)))
            self.assertEqual([event.state_change.state for event in events
                              if event.HasField("state_change")], states)


if __name__ == "__main__":
    unittest.main()
