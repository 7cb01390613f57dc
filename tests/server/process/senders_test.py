"""Callers who announce a volume and do not send it: they keep nobody out."""

import contextlib
import queue
import tempfile
import unittest

import grpc
import numpy as np

import server_process
from durable_case import DurableTest, large_volume, volume
from interface import (Code, bearer, durable, example, service, service_grpc, torus_loops,
                       volume_pb2, volumes)
from server_process import ServerProcess, new_token

LIMIT_MS = 700
PLACES = ("--max-jobs", "1", "--max-queue", "1", "--threads", "1")


class Sender:
    """A Skeletonize call that sends what it is told to, and no end."""

    def __init__(self, channel, declaration, metadata=()):
        self.requests = queue.Queue()
        self.send(config=service.SkeletonizeConfig(volume=declaration))
        self.replies = service_grpc.SkeletonizationServiceStub(channel).Skeletonize(
            iter(self.requests.get, None), metadata=metadata, timeout=server_process.TIMEOUT_S)

    def send(self, **request):
        self.requests.put(service.SkeletonizeRequest(**request))

    def accepted(self):
        return next(self.replies).accepted

    def reason(self):
        """Why the call was ended. Waits for it."""
        try:
            list(self.replies)
        except grpc.RpcError as error:
            return error.code(), example.error_reason(error), error.details()
        finally:
            self.requests.put(None)
        return None


class SilentSenderTest(unittest.TestCase):
    def test_a_place_is_lost_with_the_time_to_send_and_the_error_says_what_to_do(self):
        declaration, data = volume()
        with ServerProcess(*PLACES, "--sender-timeout-ms", str(LIMIT_MS), "--metrics-listen",
                           "127.0.0.1:0") as server, contextlib.ExitStack() as stack:
            page = server.line_after("metrics at ")
            channel = stack.enter_context(grpc.insecure_channel(server.address))
            silent, slow = Sender(channel, declaration), Sender(channel, declaration)
            for sender in (silent, slow):
                sender.accepted()
            slow.send(chunk=volume_pb2.VolumeChunk(data=data[:10]))  # a drop does not help
            for sender in (silent, slow):
                code, reason, details = sender.reason()
                self.assertEqual((code, reason), (Code.ABORTED, "SENDER_TIMEOUT"))
                self.assertIn(f"{LIMIT_MS} ms", details)
                self.assertIn("sender-timeout-ms", details)
            self.assertEqual(durable.patiently(lambda: torus_loops(channel)), 1)
            lines = server_process.metrics_after(page, 3)
        self.assertEqual(lines['bccskel_jobs_total{code="ABORTED",reason="SENDER_TIMEOUT",'
                               'tenant="default"}'], "2")


class SilentDurableSenderTest(DurableTest):
    def test_its_upload_stays_and_its_place_does_not(self):
        self.start(*PLACES[:4], "--sender-timeout-ms", str(LIMIT_MS))
        declaration, _ = large_volume()
        senders = [Sender(self.channel, declaration) for _ in range(2)]
        uploads = [sender.accepted().upload for sender in senders]
        for sender in senders:
            self.assertEqual(sender.reason()[:2], (Code.ABORTED, "SENDER_TIMEOUT"))
        for upload in uploads:
            found = self.volumes.GetUploadStatus(volumes.GetUploadStatusRequest(upload=upload))
            self.assertEqual(found.upload.committed_size, 0)
        self.assertEqual(durable.patiently(lambda: torus_loops(self.channel)), 1)

    def test_an_upload_of_a_volume_ends_in_time_and_goes_on_later(self):
        self.start("--sender-timeout-ms", str(LIMIT_MS))
        declaration, data = volume()
        requests = queue.Queue()

        def send(**request):
            requests.put(volumes.UploadVolumeRequest(**request))

        send(config=volumes.UploadVolumeConfig(upload="uploads/silent", volume=declaration))
        send(chunk=volume_pb2.VolumeChunk(data=data[:10]))
        self.fails(Code.ABORTED, "SENDER_TIMEOUT", lambda: self.volumes.UploadVolume(
            iter(requests.get, None), timeout=server_process.TIMEOUT_S))
        requests.put(None)
        self.assertEqual(durable.committed_size(self.volumes, "uploads/silent"), 10)


class SilentReaderTest(unittest.TestCase):
    def test_who_does_not_read_a_result_loses_its_memory(self):
        noise = np.random.default_rng(1).random((2, 64, 64, 64)) < 0.35
        with ServerProcess("--reader-timeout-ms", str(LIMIT_MS), "--metrics-listen",
                           "127.0.0.1:0") as server, contextlib.ExitStack() as stack:
            page = server.line_after("metrics at ")
            # Without the probe the client takes 64 KiB unread. With it the window grows with the
            # measured bandwidth, at times so far that the whole result fits.
            channel = stack.enter_context(grpc.insecure_channel(
                server.address, options=(("grpc.http2.bdp_probe", 0),)))
            unread = service_grpc.SkeletonizationServiceStub(channel).Skeletonize(
                example.requests(noise), timeout=server_process.TIMEOUT_S)
            server.wait_for_event("call ended")
            self.assertIn('"reason":"READER_TIMEOUT"', server.log_text())
            self.assertIn(f"{LIMIT_MS} ms (reader-timeout-ms)", server.log_text())
            lines = server_process.metrics(page)
            self.assertEqual((lines["bccskel_jobs_admitted"],
                              lines["bccskel_memory_admitted_bytes"]), ("0", "0"))
            with self.assertRaises(grpc.RpcError):
                list(unread)


class SharesTest(unittest.TestCase):
    def test_no_tenant_takes_all_places_where_there_are_others(self):
        (greedy, first), (other, second) = new_token("greedy"), new_token("other")
        with tempfile.NamedTemporaryFile("w") as tokens:
            tokens.write(f"{first}\n{second}\n")
            tokens.flush()
            with ServerProcess("--tokens", tokens.name, "--max-jobs", "2", "--max-queue",
                               "4") as server, grpc.insecure_channel(server.address) as channel:
                declaration, _ = volume()
                metadata = bearer(greedy)
                senders = [Sender(channel, declaration, metadata) for _ in range(3)]
                for sender in senders:
                    sender.accepted()
                refused = Sender(channel, declaration, metadata).reason()
                self.assertEqual(refused[:2], (Code.UNAVAILABLE, "QUEUE_FULL"))
                self.assertIn("half", refused[2])
                stub = service_grpc.SkeletonizationServiceStub(channel)
                replies = list(stub.Skeletonize(
                    example.requests(example.torus()), timeout=server_process.TIMEOUT_S,
                    metadata=bearer(other)))
                self.assertTrue(replies[-1].HasField("summary"))
                for sender in senders:
                    sender.requests.put(None)


if __name__ == "__main__":
    unittest.main()
