"""The Python code of the interface, which Debian's protoc makes as client/examples say, those
examples, and calls with them, for the tests beside this."""

import importlib
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import grpc

from server_process import SOURCE, TIMEOUT_S, ServerProcess

EXAMPLES = SOURCE / "client/examples"
STUBS = tempfile.TemporaryDirectory()
PROTOS = sorted((SOURCE / "proto/bccskel/v1").glob("*.proto"))

subprocess.run([os.environ["PROTOC"], "-I", SOURCE / "proto", f"--python_out={STUBS.name}",
                f"--grpc_python_out={STUBS.name}",
                f"--plugin=protoc-gen-grpc_python={os.environ['GRPC_PYTHON_PLUGIN']}", *PROTOS],
               check=True)
sys.path[:0] = [STUBS.name, str(EXAMPLES)]

import durable  # noqa: E402  (what follows needs the stubs)
import skeletonize as example  # noqa: E402
import skeletonize_labels as labels_example  # noqa: E402
from bccskel.v1 import admin_service_pb2 as admin  # noqa: E402
from bccskel.v1 import admin_service_pb2_grpc as admin_grpc  # noqa: E402
from bccskel.v1 import options_pb2  # noqa: E402
from bccskel.v1 import rpc_details_pb2 as details  # noqa: E402

jobs, jobs_grpc = durable.jobs, durable.jobs_grpc
volumes, volumes_grpc, volume_pb2 = durable.volumes, durable.volumes_grpc, durable.volume_pb2
service, service_grpc = example.service, example.service_grpc
Code = grpc.StatusCode


def services():
    """The descriptors of all services of the interface."""
    modules = [importlib.import_module(f"bccskel.v1.{path.stem}_pb2") for path in PROTOS]
    return [service for module in modules
            for service in module.DESCRIPTOR.services_by_name.values()]


def run_python(*arguments, **more):
    """Python in a process of its own, which finds the stubs and the examples."""
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, "PYTHONPATH": f"{STUBS.name}:{EXAMPLES}"},
                          timeout=TIMEOUT_S, **more)


def connect(address):
    """A channel that shares its connection with no other."""
    return grpc.insecure_channel(address, [("grpc.use_local_subchannel_pool", 1)])


def bearer(token):
    """The metadata of a call with the token, if any."""
    return (("authorization", f"Bearer {token}"),) if token else ()


def shell_width(width):
    """Options with which jobs of one volume differ."""
    return options_pb2.SkeletonizeOptions(shell_width=width)


def torus_loops(channel):
    """1, where the server works."""
    return example.skeletonize(channel, example.torus()).summary.certificate.skeleton.loops


def torus_loops_at(address):
    with grpc.insecure_channel(address) as channel:
        grpc.channel_ready_future(channel).result(TIMEOUT_S)
        return torus_loops(channel)


class HeldBack:
    """Requests of which the first are sent, and the others when they are let go."""

    def __init__(self, requests, first=1):
        self.requests, self.first, self.go_on = requests, first, threading.Event()
        self.let_go = self.go_on.set

    def __iter__(self):
        for number, request in enumerate(self.requests):
            if number == self.first:
                self.go_on.wait(TIMEOUT_S)
            yield request
        self.go_on.wait(TIMEOUT_S)


class CallTest(unittest.TestCase):
    def fails(self, code, reason, call):
        with self.assertRaises(grpc.RpcError) as raised:
            call()
        self.assertEqual((raised.exception.code(), example.error_reason(raised.exception)),
                         (code, reason), raised.exception.details())
        return raised.exception


class ServerTest(CallTest):
    """Tests that share one server."""

    @classmethod
    def setUpClass(cls):
        cls.server = ServerProcess()
        cls.channel = grpc.insecure_channel(cls.server.address)

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        cls.server.__exit__()
