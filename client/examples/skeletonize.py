#!/usr/bin/python3
"""Sends a numpy volume to a bccskel server and reads its skeleton graph.

Needs numpy, grpcio and the Python code of the interface, which protoc generates from proto/ alone:

  protoc -I proto --python_out=stubs --grpc_python_out=stubs \
      --plugin=protoc-gen-grpc_python="$(command -v grpc_python_plugin)" proto/bccskel/v1/*.proto
  PYTHONPATH=stubs python3 client/examples/skeletonize.py volume.npy --server 127.0.0.1:50051

(On Debian: python3-grpcio python3-numpy protobuf-compiler protobuf-compiler-grpc.) Without a file
it makes a torus. A volume is a boolean array cells[s, i, j, k]: whether the lattice point
(2i, 2j, 2k) for s = 0, or (2i+1, 2j+1, 2k+1) for s = 1, belongs to the object.
"""

import argparse
import dataclasses
import hashlib
import sys

import grpc
import numpy as np

from bccskel.v1 import rpc_details_pb2
from bccskel.v1 import skeletonization_service_pb2 as service
from bccskel.v1 import skeletonization_service_pb2_grpc as service_grpc
from bccskel.v1 import volume_pb2

CHUNK_BYTES = 1 << 19


@dataclasses.dataclass
class Skeleton:
    kind: list       # per node: skeleton_pb2.SkeletonNodeKind
    node: np.ndarray         # per node: lattice point, shape (nodes, 3)
    ends: np.ndarray         # per edge: its source and target node, shape (edges, 2)
    paths: list      # per edge: its lattice points from source to target, shape (points, 3)
    radii: list      # per edge: the exact distance of each point to the background, in world units
    summary: object  # skeleton_pb2.SkeletonSummary: certificate, timings, SHA-256


def raw_planes(cells):
    """The bytes of VOLUME_ENCODING_RAW_PLANES: 32 layers of k in each little-endian word."""
    _, nx, ny, nz = cells.shape
    padded = np.zeros((2, nx, ny, (nz + 31) // 32 * 32), dtype=bool)
    padded[..., :nz] = cells
    words = np.packbits(padded, axis=-1, bitorder="little").view("<u4")  # [s, i, j, c]
    return words.transpose(0, 3, 2, 1).tobytes()                         # [s, c, j, i]


def requests(cells, spacing, options=None):
    """Config, chunks, finish."""
    data = raw_planes(cells)
    _, nx, ny, nz = cells.shape
    yield service.SkeletonizeRequest(config=service.SkeletonizeConfig(
        volume=volume_pb2.VolumeDeclaration(
            encoding=volume_pb2.VOLUME_ENCODING_RAW_PLANES,
            extent=volume_pb2.LatticeExtent(nx=nx, ny=ny, nz=nz),
            placement=volume_pb2.Placement(spacing=[spacing] * 3),
            size_bytes=len(data)),
        options=options))
    for offset in range(0, len(data), CHUNK_BYTES):
        yield service.SkeletonizeRequest(chunk=volume_pb2.VolumeChunk(
            offset=offset, data=data[offset:offset + CHUNK_BYTES]))
    yield service.SkeletonizeRequest(finish=volume_pb2.VolumeFinish(
        size_bytes=len(data), sha256=hashlib.sha256(data).digest()))


def skeletonize(channel, cells, spacing=1.0, options=None, on_progress=None, timeout=600):
    """One call. Raises grpc.RpcError; error_reason() takes it apart."""
    columns = {name: [] for name in ("kind", "node", "ends", "count", "point", "radius")}
    stub = service_grpc.SkeletonizationServiceStub(channel)
    summary = None
    for reply in stub.Skeletonize(requests(cells, spacing, options), timeout=timeout):
        if reply.HasField("shell_progress") and on_progress:
            on_progress(reply.shell_progress)
        elif reply.HasField("skeleton_chunk"):
            add(columns, reply.skeleton_chunk)
        elif reply.HasField("summary"):
            summary = reply.summary
    return assemble(columns, summary, spacing)


def add(columns, chunk):
    """The tables are the chunks' tables, one after the other."""
    nodes, edges, points = chunk.nodes, chunk.edges, chunk.points
    columns["kind"].extend(nodes.kind)
    columns["node"].extend(zip(nodes.x, nodes.y, nodes.z))
    columns["ends"].extend(zip(edges.source, edges.target))
    columns["count"].extend(edges.point_count)
    columns["point"].extend(zip(points.x, points.y, points.z))
    columns["radius"].extend(points.radius)


def assemble(columns, summary, spacing):
    """Each edge owns the next point_count rows of the point table."""
    points = np.array(columns["point"], dtype=np.int32).reshape(-1, 3)
    radii = np.array(columns["radius"]) * spacing / 2  # of lattice units
    if (len(columns["node"]), len(columns["ends"]), len(points)) != (
            summary.node_count, summary.edge_count, summary.point_count):
        raise ValueError("the summary states other numbers of rows than came")
    cuts = np.cumsum(columns["count"], dtype=np.int64)[:-1]
    has_edges = len(columns["count"]) > 0
    return Skeleton(
        kind=columns["kind"],
        node=np.array(columns["node"], dtype=np.int32).reshape(-1, 3),
        ends=np.array(columns["ends"], dtype=np.int32).reshape(-1, 2),
        paths=np.split(points, cuts) if has_edges else [],
        radii=np.split(radii, cuts) if has_edges else [],
        summary=summary)


def error_reason(error):
    """The ErrorInfo.reason of a failed call, such as VOLUME_TRUNCATED; None without details."""
    for key, value in error.trailing_metadata() or ():
        if key != "grpc-status-details-bin":
            continue
        for detail in rpc_details_pb2.Status.FromString(value).details:
            if detail.type_url.endswith("google.rpc.ErrorInfo"):
                return rpc_details_pb2.ErrorInfo.FromString(detail.value).reason
    return None


def torus(radius=24.0, tube=8.0):
    """Lattice points within `tube` of a circle of `radius`, in lattice units."""
    n, depth = int(radius + tube) + 4, int(tube) + 4
    cells = np.zeros((2, n, n, depth), dtype=bool)
    i, j, k = np.indices((n, n, depth))
    for s in (0, 1):
        x, y, z = 2 * i + s - n, 2 * j + s - n, 2 * k + s - depth
        cells[s] = (np.hypot(x, y) - radius) ** 2 + z ** 2 <= tube ** 2
    return cells


def main():
    parser = argparse.ArgumentParser(description="Skeletonizes a numpy volume on a server.")
    parser.add_argument("volume", nargs="?", help=".npy file, boolean, of shape (2, nx, ny, nz)")
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--spacing", type=float, default=1.0, help="edge of the cubic cell")
    arguments = parser.parse_args()
    cells = np.load(arguments.volume) if arguments.volume else torus()
    try:
        with grpc.insecure_channel(arguments.server) as channel:
            skeleton = skeletonize(channel, cells, arguments.spacing)
    except grpc.RpcError as error:
        sys.exit(f"{error.code().name} ({error_reason(error)}): {error.details()}")
    betti = skeleton.summary.certificate.skeleton
    print(f"{skeleton.summary.object_points} points: {len(skeleton.node)} nodes, "
          f"{len(skeleton.ends)} edges, {betti.components} components, {betti.loops} loops, "
          f"{betti.cavities} cavities")
    for (source, target), path, radii in zip(skeleton.ends, skeleton.paths, skeleton.radii):
        print(f"edge {source} - {target}: {len(path)} points, radius {radii.min():.3g} to "
              f"{radii.max():.3g}")


if __name__ == "__main__":
    main()
