"""A server with a data directory, and calls to it, for the tests beside this."""

import functools
import pathlib
import signal
import tempfile

import grpc
import numpy as np

import server_process
from interface import CallTest, durable, example, jobs, service, volume_pb2, volumes
from server_process import ServerProcess


def volume(radius=24.0, tube=8.0):
    """A declaration and its bytes."""
    return example.declare(example.torus(radius, tube), 1.0, (0, 0, 0), np.eye(3))


durable.CHUNK_BYTES = 1 << 17


@functools.cache
def large_volume():
    """More than a small job: its one-call job is durable."""
    return volume(200.0, 60.0)


def upload_requests(upload, declaration, data, begin=0, finish=False):
    """Of an upload: config, the bytes from `begin` on, and finish if wanted."""
    yield volumes.UploadVolumeRequest(config=volumes.UploadVolumeConfig(
        upload=upload, volume=declaration))
    for at in range(begin, len(data), durable.CHUNK_BYTES):
        yield volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(
            offset=at, data=data[at:at + durable.CHUNK_BYTES]))
    if finish:
        yield volumes.UploadVolumeRequest(finish=volume_pb2.VolumeFinish(size_bytes=len(data)))


def large_requests():
    declaration, data = large_volume()
    yield service.SkeletonizeRequest(config=service.SkeletonizeConfig(volume=declaration))
    for at in range(0, len(data), durable.CHUNK_BYTES):
        yield service.SkeletonizeRequest(chunk=volume_pb2.VolumeChunk(
            offset=at, data=data[at:at + durable.CHUNK_BYTES]))
    yield service.SkeletonizeRequest(finish=volume_pb2.VolumeFinish(size_bytes=len(data)))


class JobCalls:
    """Calls about durable jobs to one server."""

    def connect(self, test, server):
        test.assertTrue(server.address, server.log_text())
        test.addCleanup(server.__exit__)
        self.channel = grpc.insecure_channel(server.address)
        test.addCleanup(self.channel.close)
        grpc.channel_ready_future(self.channel).result(server_process.TIMEOUT_S)
        self.volumes = durable.volumes_grpc.VolumeServiceStub(self.channel)
        self.jobs = durable.jobs_grpc.JobServiceStub(self.channel)

    def create(self, name, request_id="", **more):
        return self.jobs.CreateJob(jobs.CreateJobRequest(
            volume=name, request_id=request_id, **more)).job

    def get(self, job):
        return self.jobs.GetJob(jobs.GetJobRequest(job=job)).job

    def finish(self, job):
        """The states that a watch tells, the last one last."""
        return [event.state_change.state for event in durable.watch(self.channel, job)
                if event.HasField("state_change")]


class DurableTest(JobCalls, CallTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data = pathlib.Path(folder.name) / "data"
        self.servers = []

    def start(self, *flags):
        """A server on the data directory; the one before, if any, has to be gone."""
        server = ServerProcess("--data-dir", str(self.data), "--threads", "1", *flags)
        self.connect(self, server)
        return server

    def kill(self, server):
        server.stop(signal.SIGKILL)

    def files(self):
        return {path for path in self.data.rglob("*") if path.is_file()}
