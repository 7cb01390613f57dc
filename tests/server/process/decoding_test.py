"""The server as a process whose children decode OpenEXR: it outlives them, and they do not outlive
it."""

import os
import pathlib
import signal
import time
import unittest

import grpc

import server_process
from server_process import ServerProcess

SKELETONIZE = "/bccskel.v1.SkeletonizationService/Skeletonize"


def seed(name):
    """The requests of a seed of the fuzzer, as bytes: a whole, good call."""
    data = (server_process.SOURCE / "tests/fuzz/seeds/request" / name).read_bytes()
    return list(server_process.framed(data))


def processes():
    """(pid, state, parent) of all."""
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        yield int(folder.name), fields[0], int(fields[1])


class DecodingTest(unittest.TestCase):
    def setUp(self):
        self.server = ServerProcess()
        self.addCleanup(self.server.__exit__)
        self.channel = grpc.insecure_channel(self.server.address)
        self.addCleanup(self.channel.close)

    def send(self, name="rod_rle_exr"):
        call = self.channel.stream_stream(SKELETONIZE)
        return call(iter(seed(name)), timeout=server_process.TIMEOUT_S)

    def children(self, states="RSDTt"):
        return [pid for pid, state, parent in processes()
                if parent == self.server.process.pid and state in states]

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.server.process.pid}/fd"))

    def send_until_it_succeeds(self):
        while True:  # the test's time limit ends it
            try:
                return list(self.send())
            except grpc.RpcError as error:
                self.assertEqual(error.code(), grpc.StatusCode.UNAVAILABLE)

    def kill_children(self):
        for pid in self.children():
            os.kill(pid, signal.SIGKILL)

    def wait_until(self, condition):
        while not condition():  # the test's time limit ends it
            time.sleep(0.01)

    def test_children_that_are_killed_are_replaced_and_leave_nothing(self):
        self.send_until_it_succeeds()
        before = self.descriptors()
        for _ in range(10):
            self.kill_children()
            self.send_until_it_succeeds()
        self.assertLessEqual(self.descriptors(), before + 2)  # a fresh child may be on its way
        self.send_until_it_succeeds()
        self.assertLessEqual(len(self.children(states="Z")), 1)  # idle ones are buried when missed

    def test_a_child_that_is_killed_at_work_ends_its_call_only(self):
        self.send_until_it_succeeds()
        error = None
        while error is None:  # a child that dies before the call takes it is replaced unseen
            error = self.error_of_a_call_whose_child_dies()
        self.assertIn(error.code(), (grpc.StatusCode.UNAVAILABLE,
                                     grpc.StatusCode.INVALID_ARGUMENT))
        self.send_until_it_succeeds()

    def error_of_a_call_whose_child_dies(self):
        for pid in self.children():
            os.kill(pid, signal.SIGSTOP)
        replies = self.send()
        try:
            next(replies)  # accepted: the volume may go to a child from now on
            self.kill_children()
            list(replies)
        except grpc.RpcError as error:
            return error
        return None

    def test_other_encodings_need_no_child(self):
        for pid in self.children():
            os.kill(pid, signal.SIGSTOP)
        self.assertTrue(list(self.send("planes")))

    def test_children_end_with_the_server_however_it_ends(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(number), ServerProcess() as server:
                children = [pid for pid, _, parent in processes() if parent == server.process.pid]
                self.assertTrue(children)
                server.stop(number)
                self.wait_until(lambda: not any(pid in children and state != "Z"
                                                for pid, state, _ in processes()))


if __name__ == "__main__":
    unittest.main()
