#!/usr/bin/python3
"""Sends a numpy array of labels to a bccskel server and reads one skeleton graph per label.

Needs what skeletonize.py beside it needs. An array is labels[z, y, x] of an integer type:
the number of the object that a voxel belongs to, 0 for the background, none negative.

  PYTHONPATH=stubs python3 client/examples/skeletonize_labels.py cells.npy --min-voxels 100
"""

import argparse
import hashlib
import sys

import grpc
import numpy as np

from bccskel.v1 import skeletonization_service_pb2 as service
from bccskel.v1 import skeletonization_service_pb2_grpc as service_grpc
from bccskel.v1 import volume_pb2
from skeletonize import CHUNK_BYTES, add, assemble, empty_columns, error_reason

TYPES = {1: volume_pb2.LABEL_TYPE_UINT8, 2: volume_pb2.LABEL_TYPE_UINT16,
         4: volume_pb2.LABEL_TYPE_UINT32, 8: volume_pb2.LABEL_TYPE_UINT64}


def as_labels(volume):
    """The array as one of the types that the server takes. Errors: TypeError, ValueError."""
    volume = np.asarray(volume)
    if volume.ndim != 3:
        raise ValueError(f"labels have the shape (nz, ny, nx), not {volume.shape}")
    if volume.dtype.kind not in "bui":
        raise TypeError(f"labels are integers, not {volume.dtype}: convert the array with astype()")
    if volume.min(initial=0) < 0:
        raise ValueError(f"labels are not negative; the least one is {volume.min()}")
    return volume.astype(f"u{volume.itemsize}", copy=False)


def declare(volume, spacing):
    """The declaration that the server needs first. The counts let it reserve less memory."""
    labels, counts = np.unique(volume[volume != 0], return_counts=True)
    nz, ny, nx = volume.shape
    return volume_pb2.LabelVolumeDeclaration(
        type=TYPES[volume.itemsize], extent=volume_pb2.LatticeExtent(nx=nx, ny=ny, nz=nz),
        placement=volume_pb2.Placement(spacing=np.broadcast_to(spacing, 3)),
        size_bytes=volume.nbytes, max_voxels=counts.sum(), max_label_voxels=counts.max(initial=0),
        max_runs=nz * ny + np.count_nonzero(volume[:, :, 1:] != volume[:, :, :-1]),
        max_labels=len(labels))


def requests(volume, spacing, config):
    """Config, chunks, finish. Raises at once what is wrong with the arguments: gRPC would hide what
    the sequence raises."""
    volume = np.ascontiguousarray(volume, dtype=volume.dtype.newbyteorder("<"))
    return sequence(service.SkeletonizeLabelsConfig(volume=declare(volume, spacing), **config),
                    volume.tobytes())


def sequence(config, data):
    yield service.SkeletonizeLabelsRequest(config=config)
    for offset in range(0, len(data), CHUNK_BYTES):
        yield service.SkeletonizeLabelsRequest(chunk=volume_pb2.VolumeChunk(
            offset=offset, data=data[offset:offset + CHUNK_BYTES]))
    yield service.SkeletonizeLabelsRequest(finish=volume_pb2.VolumeFinish(
        size_bytes=len(data), sha256=hashlib.sha256(data).digest()))


def skeletonize_labels(channel, volume, spacing=1.0, on_progress=None, timeout=600, **config):
    """Yields (label, Skeleton) in ascending order, as soon as they arrive. `config`: labels,
    min_voxels, options, threads. Raises grpc.RpcError, and TypeError or ValueError as as_labels()."""
    volume = as_labels(volume)
    stub = service_grpc.SkeletonizationServiceStub(channel)
    columns, done, summary = {}, 0, None
    for reply in stub.SkeletonizeLabels(requests(volume, spacing, config), timeout=timeout):
        if reply.HasField("label_progress") and on_progress:
            on_progress(reply.label_progress)
        elif reply.HasField("skeleton_chunk"):
            if reply.skeleton_chunk.chunk.sequence == 0:
                columns = empty_columns()
            add(columns, reply.skeleton_chunk.chunk)
        elif reply.HasField("label_summary"):
            done += 1
            yield reply.label_summary.label, assemble(columns, reply.label_summary.summary)
        elif reply.HasField("labels_summary"):
            summary = reply.labels_summary
    if summary is None or summary.labels != done:
        raise ValueError(f"{done} labels came, which are not all")


def main():
    parser = argparse.ArgumentParser(description="Skeletonizes the labels of a numpy array.")
    parser.add_argument("array", help=".npy file, integers of shape (nz, ny, nx)")
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--spacing", type=float, nargs="+", default=[1.0],
                        help="edge of the voxel, one value or one per axis x, y, z")
    parser.add_argument("--labels", type=int, nargs="+", default=[], help="default: all")
    parser.add_argument("--min-voxels", type=int, default=0)
    arguments = parser.parse_args()
    try:
        with grpc.insecure_channel(arguments.server) as channel:
            for label, skeleton in skeletonize_labels(
                    channel, np.load(arguments.array), arguments.spacing,
                    labels=arguments.labels, min_voxels=arguments.min_voxels):
                betti = skeleton.summary.certificate.skeleton
                print(f"label {label}: {len(skeleton.node)} nodes, {len(skeleton.ends)} edges, "
                      f"{betti.components} components, {betti.loops} loops, "
                      f"{betti.cavities} cavities")
    except (TypeError, ValueError) as error:
        sys.exit(f"{arguments.array}: {error}")
    except grpc.RpcError as error:
        sys.exit(f"{error.code().name} ({error_reason(error)}): {error.details()}")


if __name__ == "__main__":
    main()
