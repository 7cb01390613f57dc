#!/usr/bin/python3
"""Computes a skeleton as a job that the server keeps: nothing is lost with a connection, the caller's
process or the server's. Needs a server with --data-dir, and what skeletonize.py beside it needs.

  PYTHONPATH=stubs python3 client/examples/durable.py --server 127.0.0.1:50051
"""

import argparse
import hashlib
import sys
import time
import uuid

import grpc
import numpy as np

from bccskel.v1 import job_service_pb2 as jobs
from bccskel.v1 import job_service_pb2_grpc as jobs_grpc
from bccskel.v1 import volume_pb2
from bccskel.v1 import volume_service_pb2 as volumes
from bccskel.v1 import volume_service_pb2_grpc as volumes_grpc
from skeletonize import (CHUNK_BYTES, add, assemble, declare, empty_columns, error_reason,
                         torus)

CALL_S, STREAM_S = 60, 3600
ENDED = (jobs.JOB_STATE_SUCCEEDED, jobs.JOB_STATE_FAILED, jobs.JOB_STATE_CANCELLED)


def is_unavailable(error):
    """Also of a call that gRPC cancels because it reaches a server that is about to stop: such an
    error, unlike those of the server's own, has no reason."""
    cancelled = error.code() == grpc.StatusCode.CANCELLED and not error_reason(error)
    return cancelled or error.code() == grpc.StatusCode.UNAVAILABLE


def patiently(attempt, patience_s=120, again=()):
    """Retries while the server is unavailable or busy; every call here may be repeated."""
    give_up, pause = time.monotonic() + patience_s, 0.1
    while True:
        try:
            return attempt()
        except grpc.RpcError as error:
            worth_it = is_unavailable(error) or error.code() in again
            if not worth_it or time.monotonic() > give_up:
                raise
        time.sleep(pause)
        pause = min(2 * pause, 5)


def upload_requests(upload, declaration, data, offset):
    """Config, the bytes that the server does not have, finish."""
    yield volumes.UploadVolumeRequest(config=volumes.UploadVolumeConfig(
        upload=upload, volume=declaration))
    for at in range(offset, len(data), CHUNK_BYTES):
        yield volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(
            offset=at, data=data[at:at + CHUNK_BYTES]))
    yield volumes.UploadVolumeRequest(finish=volume_pb2.VolumeFinish(
        size_bytes=len(data), sha256=hashlib.sha256(data).digest()))


def committed_size(stub, upload):
    try:
        status = stub.GetUploadStatus(volumes.GetUploadStatusRequest(upload=upload), timeout=CALL_S)
        return status.upload.committed_size
    except grpc.RpcError as error:
        if error.code() != grpc.StatusCode.NOT_FOUND:
            raise
        return 0


def send_volume(channel, declaration, data, upload=None):
    """The volume's name. Sends only what the server does not have."""
    stub = volumes_grpc.VolumeServiceStub(channel)
    key = volumes.VolumeKey(declaration=declaration, blob_sha256=hashlib.sha256(data).digest())
    found = patiently(lambda: stub.FindMissingVolumes(
        volumes.FindMissingVolumesRequest(volumes=[key]), timeout=CALL_S))
    if found.volumes[0]:
        return found.volumes[0]
    begun = upload is not None
    upload = upload or f"uploads/{uuid.uuid4()}"

    def send():
        nonlocal begun
        offset = committed_size(stub, upload) if begun else 0
        begun = True
        return stub.UploadVolume(upload_requests(upload, declaration, data, offset),
                                 timeout=STREAM_S)

    # OUT_OF_RANGE: bytes of a broken stream arrived after the query of their number.
    return patiently(send, again=(grpc.StatusCode.OUT_OF_RANGE,)).upload.volume


def create_job(channel, volume, **wanted):
    """The job's name. `wanted`: options, priority and so on, as in CreateJobRequest."""
    request = jobs.CreateJobRequest(request_id=str(uuid.uuid4()), volume=volume, **wanted)
    stub = jobs_grpc.JobServiceStub(channel)
    return patiently(lambda: stub.CreateJob(request, timeout=CALL_S)).job.name


def watch(channel, job, after_sequence=0):
    """Events until the job has ended, across broken connections."""
    stub, known = jobs_grpc.JobServiceStub(channel), after_sequence
    ended = False
    while not ended:
        try:
            request = jobs.WatchJobRequest(job=job, after_sequence=known)
            for event in stub.WatchJob(request, timeout=STREAM_S):
                known = event.sequence
                ended = event.state_change.state in ENDED
                yield event
            if not ended:
                raise RuntimeError(f"the watch ended before {job} did")
        except grpc.RpcError as error:
            if not is_unavailable(error):
                raise
            time.sleep(0.2)


def read_skeleton(channel, job):
    """The result of a job that succeeded, across broken connections."""
    columns = empty_columns()
    stub, pieces, summary = jobs_grpc.JobServiceStub(channel), 0, None

    def read_on():
        nonlocal pieces, summary
        request = jobs.ReadSkeletonRequest(job=job, piece_index=pieces)
        for piece in stub.ReadSkeleton(request, timeout=STREAM_S):
            pieces += 1
            if piece.HasField("skeleton_chunk"):
                add(columns, piece.skeleton_chunk)
            elif piece.HasField("summary"):
                summary = piece.summary

    patiently(read_on)
    return assemble(columns, summary)


def main():
    parser = argparse.ArgumentParser(description="Skeletonizes a torus in a durable job.")
    parser.add_argument("--server", default="127.0.0.1:50051")
    arguments = parser.parse_args()
    declaration, data = declare(torus(60.0, 20.0), 1.0, (0, 0, 0), np.eye(3))
    try:
        with grpc.insecure_channel(arguments.server) as channel:
            job = create_job(channel, send_volume(channel, declaration, data))
            print(job)
        # The connection is lost, but the job continues.
        with grpc.insecure_channel(arguments.server) as channel:
            for event in watch(channel, job):
                if event.HasField("state_change"):
                    print(jobs.JobState.Name(event.state_change.state))
            skeleton = read_skeleton(channel, job)
    except grpc.RpcError as error:
        sys.exit(f"{error.code().name} ({error_reason(error)}): {error.details()}")
    betti = skeleton.summary.certificate.skeleton
    print(f"{len(skeleton.node)} nodes, {len(skeleton.ends)} edges, {betti.loops} loops")


if __name__ == "__main__":
    main()
