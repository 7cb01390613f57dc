"""Calls and jobs that are ended in a chosen stage by their caller or their deadline, and how long it
takes until the server has their place, memory and threads again."""

import dataclasses
import threading
import time

import grpc

from interface import admin, admin_grpc, connect, durable, jobs, jobs_grpc, service_grpc

POLL_S, PATIENCE_S = 0.001, 120


class Status:
    """What the server is at, asked on a connection of its own."""

    def __init__(self, address):
        self.channel = connect(address)
        self.ask = admin_grpc.AdminServiceStub(self.channel).GetServerStatus

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.channel.close()

    def now(self):
        return self.ask(admin.GetServerStatusRequest(), timeout=PATIENCE_S)

    def is_idle(self):
        now = self.now()
        return not (now.jobs.admitted or now.busy_threads or now.admitted_bytes)

    def waits_for_none(self):
        return not self.now().jobs.waiting

    def wait_until(self, condition):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError(f"not within {PATIENCE_S} s: {self.now()}")
            time.sleep(POLL_S)


class Call:
    """A call of Skeletonize, begun when constructed. Where it `stops`, it never ends its sending;
    what comes is read by read_all() only."""

    CODES = {"cancel": grpc.StatusCode.CANCELLED, "deadline": grpc.StatusCode.DEADLINE_EXCEEDED}

    def __init__(self, channel, requests, timeout=PATIENCE_S, stops=False):
        self.requests, self.stops, self.over = requests, stops, threading.Event()
        self.begun = time.monotonic()
        self.replies = service_grpc.SkeletonizationServiceStub(channel).Skeletonize(
            self.send(), timeout=timeout)
        self.replies.add_done_callback(lambda _: self.over.set())
        self.cancel = self.replies.cancel

    def send(self):
        yield from self.requests
        if self.stops:
            self.over.wait(PATIENCE_S)

    def is_over(self):
        return self.over.is_set()

    def ended_by(self, way):
        return self.replies.code() == self.CODES[way]

    def read_all(self):
        """When the first piece of the result came, in seconds since the call began; the summary."""
        came = summary = None
        for reply in self.replies:
            if reply.HasField("skeleton_chunk") and came is None:
                came = time.monotonic() - self.begun
            elif reply.HasField("summary"):
                summary = reply.summary
        return came, summary


class StoredJob:
    """A job on the server's disk, made when constructed."""

    def __init__(self, channel, volume, options):
        self.stub, self.channel = jobs_grpc.JobServiceStub(channel), channel
        self.begun = time.monotonic()
        self.name = durable.create_job(channel, volume, options=options)

    def cancel(self):
        self.stub.CancelJob(jobs.CancelJobRequest(job=self.name), timeout=PATIENCE_S)

    def get(self):
        return self.stub.GetJob(jobs.GetJobRequest(job=self.name), timeout=PATIENCE_S).job

    def is_over(self):
        return self.get().state in durable.ENDED

    def ended_by(self, _):
        return self.get().state == jobs.JOB_STATE_CANCELLED

    def read_all(self):
        """As of a call; a job has a result when it has ended."""
        for _ in durable.watch(self.channel, self.name):
            pass
        return time.monotonic() - self.begun, self.get().summary


def interrupt(work, way, after, status, is_free):
    """Seconds from the end of `work`, `after` seconds after its beginning, until `is_free`. None
    where it was over before. Its deadline, if that is the way, is `after`."""
    time.sleep(max(0.0, work.begun + after - time.monotonic()))
    began = work.begun + after
    if way == "cancel":
        if is_free() or work.is_over():
            return None
        began = time.monotonic()
        work.cancel()
    status.wait_until(is_free)
    taken = time.monotonic() - began
    return taken if work.ended_by(way) else None


@dataclasses.dataclass
class Window:
    """When a stage begins and ends, in seconds since the work began."""

    begin: float
    end: float

    def at(self, share):
        return self.begin + share * (self.end - self.begin)


def windows(work):
    """The stages of what runs to its end."""
    came, summary = work.read_all()
    timings = summary.timings
    begin = came - timings.total.ToNanoseconds() / 1e9
    found = {"decode": Window(max(0.0, begin - timings.decode.ToNanoseconds() / 1e9), begin)}
    for name in ("preparing", "distance", "shells", "thinning", "cleanup", "pruning", "certificate",
                 "graph"):
        end = begin + getattr(timings, name).ToNanoseconds() / 1e9
        found[name] = Window(begin, end)
        begin = end
    found["read"] = Window(came, time.monotonic() - work.begun)
    return found
