#!/usr/bin/python3
"""Sends a numpy array to a bccskel server and reads its skeleton graph.

Needs numpy, grpcio and the Python code of the interface, which protoc generates from proto/ alone:

  protoc -I proto --python_out=stubs --grpc_python_out=stubs \
      --plugin=protoc-gen-grpc_python="$(command -v grpc_python_plugin)" proto/bccskel/v1/*.proto
  PYTHONPATH=stubs python3 client/examples/skeletonize.py mask.npy --swc mask.swc

(On Debian: python3-grpcio python3-numpy protobuf-compiler protobuf-compiler-grpc; python3-networkx
for to_networkx() and write_swc().) Without a file it makes a torus. An array is either

  mask[z, y, x]        a segmented image: voxels that are not 0 belong to the object
  cells[s, i, j, k]    lattice points: (2i, 2j, 2k) for s = 0, (2i+1, 2j+1, 2k+1) for s = 1
"""

import argparse
import dataclasses
import hashlib
import sys

import grpc
import numpy as np

from bccskel.v1 import rpc_details_pb2
from bccskel.v1 import skeleton_pb2
from bccskel.v1 import skeletonization_service_pb2 as service
from bccskel.v1 import skeletonization_service_pb2_grpc as service_grpc
from bccskel.v1 import volume_pb2

CHUNK_BYTES = 1 << 19


@dataclasses.dataclass
class Skeleton:
    kind: list         # per node: skeleton_pb2.SkeletonNodeKind
    node: np.ndarray   # per node: lattice point, shape (nodes, 3)
    node_radii: np.ndarray   # per node: its distance to the background, in world units
    ends: np.ndarray   # per edge: its source and target node, shape (edges, 2)
    paths: list        # per edge: its lattice points from source to target, shape (points, 3)
    shifts: list       # per edge: offset of each point to the middle, in lattice units; 0 at nodes
    radii: list        # per edge: the distance of each point to the background, in world units
    sheets: np.ndarray       # lattice points on no edge, as of surfaces, shape (points, 3)
    sheet_radii: np.ndarray  # one per point
    summary: object    # skeleton_pb2.SkeletonSummary: certificate, timings, SHA-256

    def world(self, points):
        """World coordinates of lattice points, shape (points, 3)."""
        placement = self.summary.placement
        axes = np.reshape(placement.direction or np.eye(3), (3, 3))
        scaled = np.asarray(points) * (np.array(placement.spacing or [1, 1, 1]) / 2)
        return scaled @ axes.T + np.array(placement.origin or [0, 0, 0])

    def curve(self, edge):
        """The smooth curve in the middle of the object, a world position per point of the edge.
        Each is within half the radius of its point or within the point's cell, so all lie inside."""
        way = smoothed(self.paths[edge] + self.shifts[edge]) - self.paths[edge]
        far = np.linalg.norm(self.world(way) - self.world([0, 0, 0]), axis=1) * 2 / self.radii[edge]
        cells = np.maximum(abs(way).max(axis=1), abs(way).sum(axis=1) / 1.5)
        way = way / np.maximum(1, np.minimum(far, cells))[:, np.newaxis]
        return self.world(self.paths[edge] + way)

    def to_networkx(self):
        """A MultiGraph: nodes with `position`, edges with `path` (the smooth curve), `radii` and
        `length`, all in the world. All but `length` and `kind` are arrays, which
        `networkx.write_graphml()` refuses; `to_networkx()` of the package `bccskel` has plain
        numbers and texts."""
        import networkx
        graph = networkx.MultiGraph()
        for number, position in enumerate(self.world(self.node)):
            graph.add_node(number, kind=self.kind[number], position=position)
        for edge, (source, target) in enumerate(self.ends):
            path = self.curve(edge)
            length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
            graph.add_edge(source, target, path=path, radii=self.radii[edge], length=length)
        return graph

    def write_swc(self, name):
        """Trees of points of the smooth curves. SWC cannot hold loops: each is cut at one step."""
        import networkx
        places, radii, steps = list(self.world(self.node)), list(self.node_radii), networkx.Graph()
        steps.add_nodes_from(range(len(places)))
        for edge, (source, target) in enumerate(self.ends):
            first = len(places)
            places.extend(self.curve(edge)[1:-1])
            radii.extend(self.radii[edge][1:-1])
            networkx.add_path(steps, [source, *range(first, len(places)), target])
        rows = {}  # in the order of the file: the parent of each point
        for component in networkx.connected_components(steps):
            root = min(component)
            rows[root] = None
            rows.update((child, parent) for parent, child in networkx.bfs_edges(steps, root))
        trees = list(rows.values()).count(None)
        loops = steps.number_of_edges() - len(rows) + trees
        number = {point: n + 1 for n, point in enumerate(rows)}
        types = {skeleton_pb2.SKELETON_NODE_KIND_END: 6,
                 skeleton_pb2.SKELETON_NODE_KIND_JUNCTION: 5}
        with open(name, "w", encoding="ascii") as file:
            file.write(f"# curve skeleton by bccskel, {trees} tree{'s' * (trees != 1)}\n")
            if loops:
                file.write(f"# SWC holds trees only: {loops} loop{'s' * (loops != 1)} cut\n")
            file.write("# x, y, z and radius in the unit of the spacing; curve: smooth\n"
                       "# types: 6 end, 5 junction, 0 other\n# id type x y z radius parent\n")
            for point, parent in rows.items():
                kind = types.get(self.kind[point], 0) if point < len(self.kind) else 0
                x, y, z = places[point]
                file.write(f"{number[point]} {kind} {x:.9g} {y:.9g} {z:.9g} {radii[point]:.9g} "
                           f"{number.get(parent, -1)}\n")


def smoothed(path):
    """Each point's mean with up to four neighbors on either side, the farthest at half weight: steps
    of a lattice make a straight line longer than it is. Ends stay, here also those of closed curves."""
    middles = (path[:-1] + path[1:]) / 2
    reach = np.minimum(np.minimum(np.arange(len(path)), np.arange(len(path))[::-1]), 4)
    return np.array([middles[n - r:n + r].mean(axis=0) if r else path[n]
                     for n, r in enumerate(reach)])


def raw_planes(cells):
    """The bytes of VOLUME_ENCODING_RAW_PLANES: 32 layers of k in each little-endian word."""
    _, nx, ny, nz = cells.shape
    padded = np.zeros((2, nx, ny, (nz + 31) // 32 * 32), dtype=bool)
    padded[..., :nz] = cells
    words = np.packbits(padded, axis=-1, bitorder="little").view("<u4")  # [s, i, j, c]
    return words.transpose(0, 3, 2, 1).tobytes()                         # [s, c, j, i]


def mask_bricks(mask):
    """Blocks of 16 x 4 x 8 voxels that hold a voxel or a corner of one, on two sublattices."""
    nz, ny, nx = mask.shape
    padded = np.zeros((nz // 8 * 8 + 16, ny // 4 * 4 + 8, nx // 16 * 16 + 32), dtype=bool)
    for z, y, x in np.ndindex(2, 2, 2):  # the upper corners of the voxels count, too
        padded[z:z + nz, y:y + ny, x:x + nx] |= mask
    z, y, x = padded.shape
    blocks = padded.reshape(z // 8, 8, y // 4, 4, x // 16, 16).any(axis=(1, 3, 5))
    return 2 * int(blocks.sum())


def declare(array, spacing, origin, direction):
    """The declaration that the server needs first, and the bytes. Raises ValueError for an array or
    a spacing of another shape. A value that is not a number belongs to no object."""
    if array.ndim != 3 and (array.ndim != 4 or array.shape[0] != 2):
        raise ValueError("an array has the shape (nz, ny, nx) or (2, nx, ny, nz), not "
                         f"{array.shape}")
    inside = (array != 0) & (array == array)
    placement = volume_pb2.Placement(spacing=np.broadcast_to(spacing, 3), origin=origin,
                                     direction=np.ravel(direction))
    if array.ndim == 3:
        data = np.packbits(inside, axis=None, bitorder="little").tobytes()
        nz, ny, nx = array.shape
        encoding, bricks = volume_pb2.VOLUME_ENCODING_CUBIC_MASK, mask_bricks(inside)
    else:
        data = raw_planes(inside)
        _, nx, ny, nz = array.shape
        encoding, bricks = volume_pb2.VOLUME_ENCODING_RAW_PLANES, 0
    return volume_pb2.VolumeDeclaration(
        encoding=encoding, extent=volume_pb2.LatticeExtent(nx=nx, ny=ny, nz=nz),
        placement=placement, size_bytes=len(data), max_bricks=bricks), data


def requests(array, spacing=1.0, origin=(0, 0, 0), direction=np.eye(3), options=None):
    """Config, chunks, finish. Raises at once what declare() raises: gRPC would hide what the
    sequence raises."""
    declaration, data = declare(np.asarray(array), spacing, origin, direction)
    return sequence(service.SkeletonizeConfig(volume=declaration, options=options), data)


def sequence(config, data):
    yield service.SkeletonizeRequest(config=config)
    for offset in range(0, len(data), CHUNK_BYTES):
        yield service.SkeletonizeRequest(chunk=volume_pb2.VolumeChunk(
            offset=offset, data=data[offset:offset + CHUNK_BYTES]))
    yield service.SkeletonizeRequest(finish=volume_pb2.VolumeFinish(
        size_bytes=len(data), sha256=hashlib.sha256(data).digest()))


def skeletonize(channel, array, on_progress=None, timeout=600, **volume):
    """One call. `volume`: spacing, origin, direction, options. Raises grpc.RpcError, whose reason
    error_reason() reads, and ValueError as declare(). Origin is the world position of voxel, or
    lattice point, (0, 0, 0)."""
    columns = empty_columns()
    stub = service_grpc.SkeletonizationServiceStub(channel)
    summary = None
    for reply in stub.Skeletonize(requests(array, **volume), timeout=timeout):
        if reply.HasField("shell_progress") and on_progress:
            on_progress(reply.shell_progress)
        elif reply.HasField("skeleton_chunk"):
            add(columns, reply.skeleton_chunk)
        elif reply.HasField("summary"):
            summary = reply.summary
    return assemble(columns, summary)


def empty_columns():
    """The tables that add() fills and assemble() reads."""
    return {name: [] for name in ("kind", "node", "node_radius", "ends", "count", "point", "shift",
                                  "radius", "sheet", "sheet_radius")}


def add(columns, chunk):
    """The tables are the concatenation of the chunks' tables."""
    nodes, edges, points = chunk.nodes, chunk.edges, chunk.points
    columns["kind"].extend(nodes.kind)
    columns["node"].extend(zip(nodes.x, nodes.y, nodes.z))
    columns["node_radius"].extend(nodes.radius)
    columns["ends"].extend(zip(edges.source, edges.target))
    columns["count"].extend(edges.point_count)
    columns["point"].extend(zip(points.x, points.y, points.z))
    columns["radius"].extend(points.radius)
    # Empty for chamfer distances: points are then not moved.
    shifts = zip(points.shift_x, points.shift_y, points.shift_z)
    columns["shift"].extend(shifts if points.shift_x else [(0, 0, 0)] * len(points.x))
    columns["sheet"].extend(zip(chunk.sheets.x, chunk.sheets.y, chunk.sheets.z))
    columns["sheet_radius"].extend(chunk.sheets.radius)


def assemble(columns, summary):
    """Each edge owns the next point_count rows of the point table."""
    points = np.array(columns["point"], dtype=np.int32).reshape(-1, 3)
    shifts = np.array(columns["shift"], dtype=float).reshape(-1, 3) / 64
    unit = min(summary.placement.spacing, default=1) / 2  # lattice units are along the shortest axis
    radii = np.array(columns["radius"]) * unit
    if (len(columns["node"]), len(columns["ends"]), len(points), len(columns["sheet"])) != (
            summary.node_count, summary.edge_count, summary.point_count,
            summary.sheet_point_count):
        raise ValueError("the summary states other numbers of rows than came")
    cuts = np.cumsum(columns["count"], dtype=np.int64)[:-1]
    has_edges = len(columns["count"]) > 0
    return Skeleton(
        kind=columns["kind"],
        node=np.array(columns["node"], dtype=np.int32).reshape(-1, 3),
        node_radii=np.array(columns["node_radius"]) * unit,
        ends=np.array(columns["ends"], dtype=np.int32).reshape(-1, 2),
        paths=np.split(points, cuts) if has_edges else [],
        shifts=np.split(shifts, cuts) if has_edges else [],
        radii=np.split(radii, cuts) if has_edges else [],
        sheets=np.array(columns["sheet"], dtype=np.int32).reshape(-1, 3),
        sheet_radii=np.array(columns["sheet_radius"]) * unit,
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
    parser = argparse.ArgumentParser(description="Skeletonizes a numpy array on a server.")
    parser.add_argument("array", nargs="?", help=".npy file, of shape (nz, ny, nx) or "
                        "(2, nx, ny, nz)")
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--spacing", type=float, nargs="+", default=[1.0],
                        help="edge of the voxel or cell, one value or one per axis x, y, z")
    parser.add_argument("--swc", help="write the skeleton to this file")
    arguments = parser.parse_args()
    array = np.load(arguments.array) if arguments.array else torus()
    try:
        with grpc.insecure_channel(arguments.server) as channel:
            skeleton = skeletonize(channel, array, spacing=arguments.spacing)
    except ValueError as error:
        sys.exit(f"{arguments.array or 'torus'}: {error}")
    except grpc.RpcError as error:
        sys.exit(f"{error.code().name} ({error_reason(error)}): {error.details()}")
    betti = skeleton.summary.certificate.skeleton
    print(f"{skeleton.summary.object_points} points: {len(skeleton.node)} nodes, "
          f"{len(skeleton.ends)} edges, {betti.components} components, {betti.loops} loops, "
          f"{betti.cavities} cavities")
    for (source, target), path, radii in zip(skeleton.ends, skeleton.paths, skeleton.radii):
        print(f"edge {source} - {target}: {len(path)} points, radius {radii.min():.3g} to "
              f"{radii.max():.3g}")
    if arguments.swc:
        skeleton.write_swc(arguments.swc)


if __name__ == "__main__":
    main()
