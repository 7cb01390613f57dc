"""What a promise does first: read its arguments, find the server and the Python code of the interface."""

import argparse
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
STUBS = tempfile.TemporaryDirectory()


def parser(text):
    """For a script with this text at its top."""
    made = argparse.ArgumentParser(description=text.split("\n\n", maxsplit=1)[0])
    made.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    return made


def prepare(made):
    """The arguments. Afterwards the modules of the tests of processes and of the examples can be
    imported, which read the environment, and those of the interface."""
    arguments = made.parse_args()
    os.environ["BCCSKEL_SERVER"] = str(arguments.build / "server/bccskel-server")
    os.environ.setdefault("PROTOC", "protoc")
    os.environ.setdefault("GRPC_PYTHON_PLUGIN", "/usr/bin/grpc_python_plugin")
    sys.path[:0] = [str(ROOT / "tests/server/process"), str(ROOT / "client/examples")]
    import server_process
    server_process.generate_stubs(STUBS.name)
    return arguments
