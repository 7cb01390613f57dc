"""The server as a process: flags, signals, sockets, what it prints, what memory it takes."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

import grpc

import server_process
from interface import example, run_python, service, service_grpc, torus_loops_at, volume_pb2
from server_process import ServerProcess, run_to_end


class FlagsTest(unittest.TestCase):
    def test_a_bad_flag_gives_code_2_and_a_message(self):
        for flags in (["--no-such-flag"], ["--threads", "0"], ["--listen", "127.0.0.1:99999"],
                      ["--log-level", "loud"], ["surplus"]):
            ended = run_to_end(*flags)
            self.assertEqual(ended.returncode, 2, flags)
            self.assertIn(flags[0], ended.stderr)
            self.assertEqual(ended.stdout, "")

    def test_a_token_that_cannot_be_printed_gives_code_1(self):
        for flags in (["--new-token", "acme"], ["--check-config"], ["--help"]):
            with open("/dev/full", "w") as full:
                ended = subprocess.run([server_process.BINARY, *flags], stdout=full, stderr=subprocess.PIPE,
                                       text=True, timeout=60)
            self.assertEqual(ended.returncode, 1, flags)
            self.assertIn("bccskel-server: cannot write to standard output", ended.stderr)

    def test_an_address_that_cannot_be_listened_on_gives_code_1(self):
        for address in ("203.0.113.1:1", "unix:/no/such/folder/socket"):
            ended = run_to_end("--listen", address)
            self.assertEqual(ended.returncode, 1, address)
            self.assertIn("bccskel-server: cannot", ended.stderr)

    def test_the_log_is_json_lines_and_standard_output_the_address(self):
        with ServerProcess() as server:
            self.assertRegex(server.greeting, r"^listening on 127\.0\.0\.1:[1-9][0-9]*\n$")
            self.assertEqual(torus_loops_at(server.address), 1)
            server.wait_for_event("call ended")  # the caller may know sooner
            self.assertEqual(server.stop(), 0)
            self.assertEqual(server.process.stdout.read(), "")
            events = [json.loads(line)["event"] for line in server.log_text().splitlines()]
        self.assertEqual(events, ["listening", "job accepted", "call ended", "draining", "drained"])

    def test_the_log_level_silences(self):
        with ServerProcess("--log-level", "error") as server:
            self.assertEqual(torus_loops_at(server.address), 1)
            self.assertEqual(server.stop(), 0)
            self.assertEqual(server.log_text(), "")

    def test_a_limit_that_leaves_room_for_no_job_is_told(self):
        with tempfile.TemporaryDirectory() as data, ServerProcess(
                "--data-dir", data, "--max-memory-bytes", "1", "--max-disk-bytes", "10") as server:
            self.assertEqual(server.stop(), 0)
            for limit in ("max-memory-bytes is 1:", "max-disk-bytes is 10:"):
                self.assertIn(limit, server.log_text())
        with ServerProcess() as server:
            self.assertEqual(server.stop(), 0)
            self.assertNotIn("limit too small", server.log_text())


class SignalTest(unittest.TestCase):
    def test_sigterm_and_sigint_end_an_idle_server_well(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with ServerProcess() as server:
                self.assertEqual(server.stop(number), 0)

class UnixSocketTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name) / "server.sock"
        self.listen = f"unix:{self.path}"

    def test_a_clean_end_leaves_no_file(self):
        with ServerProcess(listen=self.listen) as server:
            self.assertEqual(server.address, self.listen)
            self.assertEqual(torus_loops_at(self.listen), 1)
            self.assertEqual(server.stop(), 0)
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_after_a_kill_the_next_server_takes_the_same_path(self):
        for _ in range(3):
            with ServerProcess(listen=self.listen) as server:
                self.assertEqual(torus_loops_at(self.listen), 1)
                self.assertEqual(server.stop(signal.SIGKILL), -signal.SIGKILL)
            self.assertTrue(self.path.exists())
        with ServerProcess(listen=self.listen) as server:
            self.assertEqual(torus_loops_at(self.listen), 1)
            self.assertEqual(server.stop(), 0)

    def test_two_servers_do_not_share_a_path(self):
        with ServerProcess(listen=self.listen) as first:
            second = run_to_end("--listen", self.listen)
            self.assertEqual(second.returncode, 1)
            self.assertIn("another server listens", second.stderr)
            self.assertEqual(torus_loops_at(self.listen), 1)
            self.assertEqual(first.stop(), 0)


VANISHING_CALLER = """
import os, signal, sys
import grpc
import skeletonize
def half():
    for number, message in enumerate(skeletonize.requests(skeletonize.torus(90.0, 30.0))):
        if number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        yield message
stub = skeletonize.service_grpc.SkeletonizationServiceStub(grpc.insecure_channel(sys.argv[1]))
list(stub.Skeletonize(half()))
"""


class LoadTest(unittest.TestCase):
    def test_the_place_of_a_caller_who_is_killed_is_free_again(self):
        with ServerProcess("--max-jobs", "1", "--max-queue", "0") as server:
            caller = run_python("-c", VANISHING_CALLER, server.address)
            self.assertEqual(caller.returncode, -signal.SIGKILL)
            while True:  # the test's time limit ends it
                try:
                    self.assertEqual(torus_loops_at(server.address), 1)
                    break
                except grpc.RpcError as error:
                    self.assertEqual(example.error_reason(error), "QUEUE_FULL")

    def test_a_declared_giant_is_refused_before_memory_is_taken(self):
        with ServerProcess("--max-memory-bytes", "1GB") as server:
            self.assertEqual(torus_loops_at(server.address), 1)
            before = server.peak_bytes()
            with grpc.insecure_channel(server.address) as channel:
                for cells, bricks in ((4_000_000, 0), (4_000, 0), (4_000_000, 1 << 23)):
                    words = (cells + 31) // 32
                    declaration = volume_pb2.VolumeDeclaration(
                        encoding=volume_pb2.VOLUME_ENCODING_RAW_PLANES,
                        extent=volume_pb2.LatticeExtent(nx=cells, ny=cells, nz=cells),
                        size_bytes=8 * cells * cells * words, max_bricks=bricks)
                    with self.assertRaises(grpc.RpcError) as raised:
                        list(service_grpc.SkeletonizationServiceStub(channel).Skeletonize(iter(
                            [service.SkeletonizeRequest(
                                config=service.SkeletonizeConfig(volume=declaration))])))
                    self.assertEqual(raised.exception.code(), grpc.StatusCode.RESOURCE_EXHAUSTED)
            self.assertLess(server.peak_bytes() - before, 16 << 20)


if __name__ == "__main__":
    unittest.main()
