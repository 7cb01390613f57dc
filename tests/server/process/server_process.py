"""bccskel-server as a process, for the tests beside this."""

import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import urllib.request

BINARY = os.environ["BCCSKEL_SERVER"]
SOURCE = pathlib.Path(__file__).resolve().parents[3]
TIMEOUT_S = 120


class ServerProcess:
    """Listens when constructed. The `with` block kills what is left of it."""

    def __init__(self, *flags, listen="127.0.0.1:0"):
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen([BINARY, "--listen", listen, *flags],
                                        stdout=subprocess.PIPE, stderr=self.log, text=True)
        self.greeting = self.process.stdout.readline()
        self.address = self.greeting.removeprefix("listening on ").strip()

    def line_after(self, prefix):
        """What follows `prefix` in one of the next lines that the server prints at its start."""
        for line in self.process.stdout:
            if line.startswith(prefix):
                return line.removeprefix(prefix).strip()
        raise RuntimeError(f"no line begins with {prefix}: {self.log_text()}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.log.close()

    def stop(self, number=signal.SIGTERM):
        """The exit code after the signal."""
        self.process.send_signal(number)
        return self.process.wait(TIMEOUT_S)

    def log_text(self):
        # The server writes where this file's offset is, so reading must not move it.
        log = self.log.fileno()
        return os.pread(log, os.fstat(log).st_size, 0).decode()

    def wait_for_event(self, event):
        """Until the log tells of it: its thread may write later than a call is answered. The
        test's time limit ends it."""
        while f'"event":"{event}"' not in self.log_text():
            time.sleep(0.02)

    def forget_peak(self):
        """The peak is what it takes now."""
        pathlib.Path(f"/proc/{self.process.pid}/clear_refs").write_text("5")

    def peak_bytes(self):
        return self.memory_bytes("VmHWM")

    def resident_bytes(self):
        return self.memory_bytes("VmRSS")

    def memory_bytes(self, name):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(rf"^{name}:\s+(\d+) kB$", status, re.MULTILINE)[1]) * 1024


def metrics(page):
    """The lines of a metrics page: the values, as text, by name and labels."""
    with urllib.request.urlopen(page, timeout=TIMEOUT_S) as answer:
        lines = answer.read().decode().splitlines()
    return dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))


def metrics_after(page, number, counter="bccskel_jobs_total"):
    """The same, as soon as the counter's series sum up to the number: callers may hear of an end
    before it is counted. The test's time limit ends it."""
    while True:
        lines = metrics(page)
        if sum(float(value) for name, value in lines.items() if name.startswith(counter)) >= number:
            return lines
        time.sleep(0.01)


def run_to_end(*flags):
    """For flags with which the server does not start."""
    return subprocess.run([BINARY, *flags], capture_output=True, text=True, timeout=TIMEOUT_S,
                          check=False)


def new_token(tenant):
    """A token and its line."""
    made = run_to_end("--new-token", tenant)
    assert made.returncode == 0, made.stderr
    return made.stdout.splitlines()


def health(channel, service=""):
    """1 for SERVING, 2 for NOT_SERVING; grpc.health.v1 needs no stubs for this."""
    request = b"\x0a" + bytes([len(service)]) + service.encode()
    return channel.unary_unary("/grpc.health.v1.Health/Check")(request, timeout=TIMEOUT_S)[1]


def framed(seed):
    """The requests of a fuzzer's seed: a byte, then each with its size as a varint before it."""
    at = 1
    while at < len(seed):
        size, shift = 0, 0
        while True:
            byte, at = seed[at], at + 1
            size, shift = size | (byte & 0x7F) << shift, shift + 7
            if byte < 0x80:
                break
        yield seed[at:at + size]
        at += size
