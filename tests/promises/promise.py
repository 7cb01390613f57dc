"""What a promise does first: read its arguments and find the server."""

import argparse
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def parser(text):
    """For a script with this text at its top."""
    made = argparse.ArgumentParser(description=text.split("\n\n", maxsplit=1)[0])
    made.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    return made


def prepare(made):
    """The arguments. Afterwards the modules of the tests of processes, which read the environment,
    can be imported."""
    arguments = made.parse_args()
    os.environ["BCCSKEL_SERVER"] = str(arguments.build / "server/bccskel-server")
    os.environ.setdefault("PROTOC", "protoc")
    os.environ.setdefault("GRPC_PYTHON_PLUGIN", "/usr/bin/grpc_python_plugin")
    sys.path.insert(0, str(ROOT / "tests/server/process"))
    return arguments
