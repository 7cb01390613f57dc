"""The service through nginx, as docker/nginx sets it up: same results, and errors that clients
understand."""

import pathlib
import tempfile
import threading
import unittest

import grpc
import numpy as np

import nginx_process
from certificates import Authority
from interface import CallTest, Code, example, services, torus_loops
from nginx_process import nginx_in_front
from server_process import ServerProcess


@unittest.skipIf(nginx_process.NGINX is None, "nginx is not installed")
class NginxTest(CallTest):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.socket = f"{self.path}/server.sock"

    def front(self, pair=None):
        front = nginx_in_front(self.path, self.socket, pair=pair)
        address = front.__enter__()
        self.addCleanup(front.__exit__, None, None, None)
        return address

    def channel(self, address):
        channel = grpc.insecure_channel(address)
        self.addCleanup(channel.close)
        return channel

    def test_the_skeleton_is_the_same_as_without_nginx(self):
        front = self.front()
        with ServerProcess(listen=f"unix:{self.socket}"):
            ways = [example.skeletonize(self.channel(address), example.torus()).summary.sha256
                    for address in (front, f"unix:{self.socket}")]
        self.assertEqual(ways[0], ways[1])

    def test_the_example_of_a_listener_with_tls_works(self):
        authority = Authority(self.path, "ours")
        front = self.front(authority.issue("front"))
        credentials = grpc.ssl_channel_credentials(authority.certificate_bytes())
        with (ServerProcess(listen=f"unix:{self.socket}"),
              grpc.secure_channel(front, credentials) as channel):
            self.assertEqual(torus_loops(channel), 1)

    def test_a_volume_of_megabytes_passes(self):
        """nginx by itself stops at 1 MiB."""
        noise = np.zeros((2, 200, 200, 200), bool)  # all of which is sent
        noise[:, 60:140, 60:140, 60:140] = np.random.default_rng(1).random((2, 80, 80, 80)) < 0.5
        noise[:, 61:139, 61:139, 61:139] = True  # one component with a rough surface
        front = self.front()
        with ServerProcess(listen=f"unix:{self.socket}"):
            skeleton = example.skeletonize(self.channel(front), noise)
        self.assertEqual(skeleton.summary.object_points, int(noise.sum()))

    def test_an_error_keeps_its_code_and_details(self):
        front = self.front()
        with ServerProcess("--max-volume-bytes", "1000", listen=f"unix:{self.socket}"):
            error = self.fails(Code.RESOURCE_EXHAUSTED, "VOLUME_TOO_LARGE",
                               lambda: torus_loops(self.channel(front)))
        self.assertIn("limit is 1000", error.details())

    def test_without_a_server_callers_hear_that_they_may_try_again(self):
        self.fails(Code.UNAVAILABLE, None, lambda: torus_loops(self.channel(self.front())))

    def test_other_services_stay_inside(self):
        front = self.front()
        with ServerProcess(listen=f"unix:{self.socket}"):
            channel = self.channel(front)
            for method in ("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
                           "/bccskel.v1.AdminService/GetServerStatus"):
                self.fails(Code.UNIMPLEMENTED, None,
                           lambda: channel.unary_unary(method)(b"", timeout=60))
            for service in services():
                if service.name == "AdminService":
                    continue
                unknown = channel.unary_unary(f"/{service.full_name}/NoSuchMethod")
                with self.assertRaises(grpc.RpcError) as caught:
                    unknown(b"", timeout=60)
                self.assertEqual(caught.exception.details(), "", "the server itself says so")

    def test_who_calls_too_often_is_told_so(self):
        front = self.front()
        with ServerProcess(listen=f"unix:{self.socket}"):
            ask = self.channel(front).unary_unary("/bccskel.v1.ServerService/GetCapabilities")
            calls = [ask.future(b"", timeout=60) for _ in range(1500)]
            errors = [call.exception() for call in calls]
        refused = [error for error in errors if error is not None]
        self.assertGreater(len(refused), 0)
        for error in refused:
            self.assertEqual(error.code(), Code.UNAVAILABLE)
            self.assertIn("slow down", error.details())

    def test_who_has_too_many_calls_open_is_told_so(self):
        """nginx counts calls that are open as connections."""
        front, end = self.front(), threading.Event()
        self.addCleanup(end.set)

        def nothing():
            end.wait()
            yield from ()

        with ServerProcess(listen=f"unix:{self.socket}"):
            call = self.channel(front).stream_stream(
                "/bccskel.v1.SkeletonizationService/Skeletonize")
            calls = [call(nothing(), timeout=60) for _ in range(105)]
            refused = self.fails(Code.UNAVAILABLE, None, lambda: list(calls[-1]))
            end.set()
        self.assertIn("100 calls at a time", refused.details())


if __name__ == "__main__":
    unittest.main()
