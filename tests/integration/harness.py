"""Runs the command line and the server for the tests of this folder."""

import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

CLIENT = os.environ["BCCSKEL"]
SERVER = os.environ["BCCSKEL_SERVER"]
DATA = pathlib.Path(os.environ.get("BCCSKEL_TEST_DATA", ""))
SOURCES = pathlib.Path(__file__).resolve().parents[2]
SANITIZED = bool(os.environ.get("BCCSKEL_SANITIZE"))


def limit_memory(gib):
    """For a child process. Sanitizers reserve terabytes, so they go without."""
    def apply():
        if not SANITIZED:
            resource.setrlimit(resource.RLIMIT_AS, (gib << 30, gib << 30))
    return apply


def bccskel(*words, timeout=300, **options):
    """Runs the command line to its end, with pipes for its output."""
    return subprocess.run([CLIENT, *map(str, words)], capture_output=True, text=True,
                          timeout=timeout, **options)


def wait_until(condition, what, seconds=300):
    """Until condition() holds; long enough for a busy machine."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("never: " + what)
        time.sleep(0.01)


def signals_of(process, field):
    """Signal numbers in a line of /proc/PID/status."""
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        name, _, mask = line.partition(":")
        if name == field:
            return {n for n in range(1, 65) if int(mask, 16) >> (n - 1) & 1}
    return set()


def interrupt(process):
    """Sends Ctrl-C to a command line as soon as that can handle it, until it has taken it."""
    wait_until(lambda: signal.SIGINT in signals_of(process, "SigBlk") or process.poll() is not None,
               "the command line handles SIGINT")
    process.send_signal(signal.SIGINT)
    wait_until(lambda: signal.SIGINT not in signals_of(process, "ShdPnd"), "SIGINT was taken")


class Server:
    """A running server, its log in a file; for a `with` statement."""

    def __init__(self, folder, *options, name="server", listen=None):
        self.listen = listen or f"unix:{folder}/{name}"
        self.log_path = pathlib.Path(folder) / f"{name}.log"
        self.options = options

    def __enter__(self):
        with open(self.log_path, "w") as log:
            self.process = subprocess.Popen(
                [SERVER, "--listen", self.listen, "--lame-duck-ms", "0", *self.options],
                stdout=subprocess.DEVNULL, stderr=log)
        self.address = self.wait_for_log("address")["address"]
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise

    def log(self):
        lines = self.log_path.read_text().splitlines(keepends=True)
        return [json.loads(line) for line in lines if line.endswith("\n")]

    def wait_for_log(self, key, value=None):
        """The first entry with the key, and the value where one is given."""
        def entries():
            return [e for e in self.log() if key in e and value in (None, e[key])]
        wait_until(lambda: entries() or self.process.poll() is not None, f"{key} in the log")
        if found := entries():
            return found[0]
        raise AssertionError("the server ended: " + self.log_path.read_text())


class TestCase(unittest.TestCase):
    """A test with a folder of its own."""

    maxDiff = 2000

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bccskel-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, content):
        """A file of this text or these bytes."""
        content = content.encode() if isinstance(content, str) else content
        (self.folder / name).write_bytes(content)
        return self.path(name)

    def tetrahedron(self, name, x=1, y=1, z=1):
        """A mesh with the origin and a corner on each axis."""
        return self.write(name, f"OFF\n4 4 0\n0 0 0\n{x} 0 0\n0 {y} 0\n0 0 {z}\n"
                                "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")

    def read_json(self, name):
        return json.loads((self.folder / name).read_text())

    def succeed(self, *words):
        """The output of a command that must succeed, quietly."""
        done = bccskel(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.args)
        return done.stdout

    def summarize(self, *words):
        """The JSON summary of a command that must succeed, with no warnings but those in it."""
        done = bccskel(*words, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads(done.stdout)
        said = summary.get("image", {}).get("warnings", []) + summary["notes"]
        warnings = [f"bccskel: warning: {summary['input']}: {line}\n" for line in said]
        self.assertEqual(done.stderr, "".join(warnings), done.args)
        return summary

    def fail_with(self, code, message, *words, **options):
        """Checks that a command ends with an exit code and a message."""
        done = bccskel(*words, **options)
        self.assertEqual(done.returncode, code, f"{done.args}: {done.stderr}")
        self.assertIn(message, done.stderr)
        self.assertTrue(done.stderr.startswith("bccskel: error: "), done.stderr)
        return done

    def generate(self, shape, points=20000, name="object.bccb"):
        self.succeed("generate", shape, "--points", points, "-o", self.path(name))
        return self.path(name)


def outputs(paths):
    """Words of a command that writes these files."""
    return [word for path in paths for word in ("-o", path)]


def topology(betti):
    """(components, loops, cavities)."""
    return betti["components"], betti["loops"], betti["cavities"]


def without_times(summary):
    """A JSON summary or document without what differs from run to run."""
    return {k: v for k, v in summary.items() if k not in ("timings", "seconds", "outputs")}


def needs_data(folder):
    path = DATA / folder
    return unittest.skipUnless(path.is_dir(), f"no {path}: set BCCSKEL_TEST_DATA")


def main():
    program = unittest.main(exit=False, verbosity=2)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if len(result.skipped) == result.testsRun else 0)
