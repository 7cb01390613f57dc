"""A skeleton as numpy arrays, as a graph, as a table and as files."""

from __future__ import annotations

import functools
import html
import math
import numbers
import os
import pathlib
import tempfile
import warnings
import webbrowser
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _native
from ._image import Frame, path_text

if TYPE_CHECKING:
    import networkx
    import pandas


class Skeleton:
    """A graph of curves with radii, as the functions of this package return it.

    Coordinates are those of the world, columns in the order of `axes`; lengths and radii are in its
    unit. Arrays are read-only, copy() makes one to change.

    >>> import numpy as np, bccskel
    >>> mask = np.zeros((12, 30, 60), bool)
    >>> mask[4:8, 13:17, 2:58] = mask[4:8, 2:16, 28:32] = True
    >>> skeleton = bccskel.skeletonize(mask)
    >>> skeleton.nodes.shape, skeleton.edges.shape, skeleton.node_kinds.tolist()
    ((4, 3), (3, 2), ['end', 'end', 'junction', 'end'])
    >>> [path.shape == (len(radii), 3) for path, radii in zip(skeleton.paths, skeleton.radii)]
    [True, True, True]
    """

    def __init__(self, outcome: Any, frame: Frame, title: str, voxels: bool = False,
                 label: Optional[int] = None, image: Any = None, unit: str = "",
                 world: str = "") -> None:
        """For internal use."""
        self._outcome = outcome
        self._frame = frame
        self._of_voxels = voxels
        self.unit = unit or getattr(image, "unit", "")
        """The unit of coordinates, radii and lengths: "mm", "um", ...; empty if unknown."""
        self.world = getattr(image, "world", world)
        """Where the axes point: "RAS", "LPS", ...; empty if unknown."""
        self.title = title
        """The title of pages and pictures."""
        self.label = label
        """The label in the image; None for the skeleton of a mask or mesh."""

    def __repr__(self) -> str:
        counts = [f"{len(rows)} {name if len(rows) == 1 else name + 's'}"
                  for rows, name in ((self.nodes, "node"), (self.edges, "edge"))]
        return (f"<Skeleton of {self.title}: {', '.join(counts)}, "
                f"length {self.lengths.sum():.6g}, {self._outcome.verdict}>")

    def __getstate__(self) -> dict:
        """For pickle and copy: everything except the arrays, which are made again on request."""
        names = ("_outcome", "_frame", "_of_voxels", "unit", "world", "title", "label")
        return {name: self.__dict__[name] for name in names}

    @functools.cached_property
    def _nodes(self) -> dict:
        return _fixed(self._outcome.nodes())

    @functools.cached_property
    def _edges(self) -> dict:
        return _fixed(self._outcome.edges())

    @functools.cached_property
    def _sheets(self) -> dict:
        return _fixed(self._outcome.sheets())

    def _columns(self, points: np.ndarray) -> np.ndarray:
        return _fixed(points[:, self._frame.from_xyz])

    @property
    def axes(self) -> str:
        """The order of coordinates: that of the array, 'zyx' by default, of a mesh 'xyz'."""
        return self._frame.axes

    @functools.cached_property
    def nodes(self) -> np.ndarray:
        """Positions of the ends, junctions and other nodes, shape (nodes, 3)."""
        return self._columns(self._nodes["positions"])

    @property
    def node_radii(self) -> np.ndarray:
        """The radius of the largest ball around each node inside the object, shape (nodes,). Of
        masks it is corrected for voxels, so that it is right on average for round limbs."""
        return self._nodes["radii"]

    @functools.cached_property
    def node_kinds(self) -> np.ndarray:
        """'end', 'junction', 'loop' (represents a closed curve), 'isolated' or 'closed_surface',
        shape (nodes,)."""
        return _fixed(np.array(self._nodes["kinds"], dtype="U14"))

    @property
    def node_components(self) -> np.ndarray:
        """The connected component of each node, from 0, shape (nodes,)."""
        return self._nodes["components"]

    @property
    def edges(self) -> np.ndarray:
        """Indices of the two nodes of each branch, shape (edges, 2)."""
        return self._edges["ends"]

    @functools.cached_property
    def paths(self) -> list:
        """For each edge the smooth curve from its first to its second node, shape (points, 3)."""
        return self._split(self._columns(self._edges["points"]))

    @functools.cached_property
    def radii(self) -> list:
        """For each edge the radii along `paths`, shape (points,)."""
        return self._split(self._edges["radii"])

    def _split(self, rows: np.ndarray) -> list:
        offsets = self._edges["offsets"].tolist()
        return [rows[begin:end] for begin, end in zip(offsets, offsets[1:])]

    @property
    def lengths(self) -> np.ndarray:
        """Lengths of the curves, shape (edges,). Blunt limbs are longer by about the radius at each
        free end."""
        return self._edges["figures"]["length"]

    @property
    def pruning_levels(self) -> np.ndarray:
        """The `pruning_threshold` above which each edge is pruned; infinite if never,
        shape (edges,)."""
        return self._edges["figures"]["pruning_level"]

    @functools.cached_property
    def sheets(self) -> np.ndarray:
        """Points on no edge, as in surface skeletons, shape (points, 3)."""
        return self._columns(self._sheets["points"])

    @property
    def sheet_radii(self) -> np.ndarray:
        """Shape (points,)."""
        return self._sheets["radii"]

    @functools.cached_property
    def order(self) -> Optional[dict]:
        """Where `root` was given, the graph as trees: of components 'roots', of nodes 'parent' (-1
        for none) and 'root_distance', of edges 'proximal' (-1 where one closes a loop),
        'generation' and 'strahler' (NaN where one closes a loop)."""
        return _fixed(self._outcome.order())

    @functools.cached_property
    def certificate(self) -> dict:
        """Proves that the topology was kept: components, loops and cavities of the mask, of
        the object and of the skeleton, and whether they agree."""
        return self._outcome.certificate

    @property
    def sha256(self) -> str:
        """Digest of the graph: equal on every machine and to that of the command line."""
        return self._outcome.sha256

    @property
    def method(self) -> str:
        """The method in words."""
        return self._outcome.method

    @property
    def options(self) -> dict:
        """Everything that the result depends on, by name."""
        return self._outcome.options

    @property
    def notes(self) -> list:
        """Notes for the user of this result, one sentence each."""
        return self._outcome.notes

    @property
    def warnings(self) -> list:
        """Warnings of the conversion to lattice points, one sentence each."""
        return self._outcome.warnings

    @property
    def timings(self) -> dict:
        """The time of each stage in seconds."""
        return self._outcome.timings

    @property
    def voxels(self) -> Optional[int]:
        """The number of voxels of the mask or the label; 0 for a mesh, None for a result that was
        read, which does not state it."""
        return self._outcome.voxels

    def to_networkx(self, points: bool = False) -> networkx.MultiGraph:
        """The graph: nodes with x, y, z, radius, kind and component, edges with length, mean_radius
        and so on, all plain numbers and texts that `networkx.write_graphml()` takes.

        points: gives each edge its `path` and `radii`, too, which GraphML cannot hold.

        >>> import numpy as np, bccskel
        >>> graph = bccskel.skeletonize(np.ones((5, 5, 40))).to_networkx()
        >>> sorted(graph.nodes[0])
        ['component', 'kind', 'radius', 'x', 'y', 'z']
        """
        import networkx

        graph = networkx.MultiGraph(sha256=self.sha256, method=self.method)
        columns = {axis: self.nodes[:, self.axes.index(axis)].tolist() for axis in "xyz"}
        columns.update(radius=self.node_radii.tolist(), kind=self._nodes["kinds"],
                       component=self.node_components.tolist())
        if self.order is not None:
            columns["root_distance"] = self.order["root_distance"].tolist()
        names = list(columns)
        graph.add_nodes_from((n, dict(zip(names, row)))
                             for n, row in enumerate(zip(*columns.values())))
        figures = {name: values.tolist() for name, values in self._edges["figures"].items()}
        if self.order is not None:
            figures.update({name: [int(n) if math.isfinite(n) else n for n in self.order[name]]
                            for name in ("generation", "strahler")})
        for n, (source, target) in enumerate(self.edges.tolist()):
            facts = {name: values[n] for name, values in figures.items()
                     if math.isfinite(values[n])}
            if points:
                facts.update(path=self.paths[n], radii=self.radii[n])
            graph.add_edge(source, target, key=n, **facts)
        return graph

    def to_pandas(self, separator: str = "-") -> pandas.DataFrame:
        """A row for each branch, with the columns of `skan.summarize()` and more.

        mean-pixel-value and stdev-pixel-value are those of the radius. image-coord is a voxel
        of the object; of samplings and labels that a server has computed, the nearest one of the
        image. Of a mesh there is no image-coord.

        >>> import numpy as np, bccskel
        >>> table = bccskel.skeletonize(np.ones((5, 5, 40))).to_pandas()
        >>> table[["branch-type", "image-coord-src-0", "image-coord-src-1"]].values.tolist()
        [[0, 2, 2]]
        """
        import pandas

        source, target = self.edges[:, 0], self.edges[:, 1]
        figures = self._edges["figures"]
        mean = self._mean_of_edges(self._edges["radii"])
        counts = np.diff(self._edges["offsets"])
        variance = self._mean_of_edges((self._edges["radii"] - np.repeat(mean, counts)) ** 2)
        table = {
            "skeleton-id": self.node_components[source],
            "node-id-src": source,
            "node-id-dst": target,
            "branch-distance": self.lengths,
            "branch-type": self._branch_types(),
            "mean-pixel-value": mean,
            "stdev-pixel-value": np.sqrt(variance),
        }
        places = {"coord": self.nodes}
        if self._of_voxels:
            places = {"image-coord": self._columns(self._outcome.node_voxels()),
                      "coord": self.nodes}
        for name, values in places.items():
            for end, index in (("src", source), ("dst", target)):
                for axis in range(3):
                    table[f"{name}-{end}-{axis}"] = values[index, axis]
        table["euclidean-distance"] = np.linalg.norm(self.nodes[source] - self.nodes[target],
                                                     axis=1)
        for name in ("tortuosity", "mean_radius", "min_radius", "max_radius", "pruning_level"):
            table[name.replace("_", "-")] = figures[name]
        if self.order is not None:
            table.update({name: self.order[name] for name in ("generation", "strahler")})
        return pandas.DataFrame({name.replace("-", separator): values
                                 for name, values in table.items()})

    def _mean_of_edges(self, values: np.ndarray) -> np.ndarray:
        """The mean over each edge of values for the points of all edges."""
        offsets = self._edges["offsets"]
        if len(offsets) == 1:
            return np.empty(0)
        return np.add.reduceat(values, offsets[:-1]) / np.diff(offsets)

    def _branch_types(self) -> np.ndarray:
        """As skan: 0 from end to end, 1 from a junction to an end, 2 between junctions, 3 a closed
        curve of its own."""
        junction = np.isin(self.node_kinds, ["junction", "closed_surface"])
        types = junction[self.edges].sum(axis=1)
        types[self.node_kinds[self.edges[:, 0]] == "loop"] = 3
        return types

    def curve_image(self) -> np.ndarray:
        """The voxels that the curves run through, in the shape of the mask: the number of the edge
        + 1 (of an isolated node, its number + 1 + the edges'), 0 elsewhere. The voxels of an edge
        are connected.

        Raises ValueError for meshes, samplings and objects that were prepared (denoise, ...).

        >>> import numpy as np, bccskel
        >>> int((bccskel.skeletonize(np.ones((5, 5, 40))).curve_image() > 0).sum())
        40
        """
        return self._of_axes(self._outcome.curve_image())

    def branch_image(self) -> np.ndarray:
        """The same for each voxel of the mask: the number of the nearest edge + 1."""
        return self._of_axes(self._outcome.branch_image())

    def _of_axes(self, image: np.ndarray) -> np.ndarray:
        return image.transpose(["zyx".index(axis) for axis in self.axes])

    def save(self, path: Union[str, os.PathLike], swc_step: Optional[float] = None) -> None:
        """Writes a file; its ending is the format: .swc, .vtp, .graphml, .obj, .json, .csv (a table of
        branches), .glb (tubes), .mrk.json (3D Slicer), .exr or .bccb (lattice points), .svg, .png, .html
        (a page) or .precomputed (a folder for Neuroglancer, in nanometers). It has the coordinates x, y, z.

        `swc_step` is the distance of SWC's points along the smooth curve, by default twice the
        smallest spacing, or an eighth of the largest if that is more; 0 writes the lattice points,
        not smoothed. A result that was read from JSON has no lattice points, and pictures and pages
        show its curves without the object.

        Raises ValueError for another ending, OSError where it cannot be written. Warns of what the
        format could not hold.

        >>> import os, tempfile
        >>> import numpy as np, bccskel
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     bccskel.skeletonize(np.ones((5, 5, 40))).save(os.path.join(folder, "bar.swc"))
        ...     os.listdir(folder)
        ['bar.swc']
        """
        if swc_step is not None and (isinstance(swc_step, bool)
                                     or not isinstance(swc_step, numbers.Real)):
            raise TypeError(f"swc_step must be a number or None, got {swc_step!r}")
        note = self._outcome.save(path_text(path), self.title, self.world, self.unit, swc_step)
        if note:
            warnings.warn(f"{os.fspath(path)}: {note}", stacklevel=2)

    def page(self) -> Page:
        """The page that shows the object and its skeleton, as HTML text."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "page.html")
            self.save(path)
            return Page(path.read_text(encoding="utf-8"))

    def view(self) -> Page:
        """Shows the page: in a notebook as the value of a cell, elsewhere in a browser. Warns where
        its file is if there is no browser."""
        page = self.page()
        if not _in_notebook():
            page.open()
        return page


def _fixed(value: Any) -> Any:
    """Arrays that files do not read must not change: tables and files would then differ."""
    for part in value.values() if isinstance(value, dict) else ():
        _fixed(part)
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    return value


class Page:
    """A self-contained page: `html` is its text."""

    def __init__(self, text: str) -> None:
        self.html = text

    def __repr__(self) -> str:
        return f"<Page of {len(self.html)} characters>"

    def _repr_html_(self) -> str:
        return ('<iframe style="width: 100%; height: 600px; border: 0" '
                f'srcdoc="{html.escape(self.html)}"></iframe>')

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes the page as one .html file."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def open(self) -> str:
        """Opens the page in a browser from a permanent file. Returns its path."""
        with tempfile.NamedTemporaryFile("w", prefix="bccskel-", suffix=".html", delete=False,
                                         encoding="utf-8") as file:
            file.write(self.html)
        if not webbrowser.open(pathlib.Path(file.name).as_uri()):
            warnings.warn(f"found no browser; the page is {file.name}", stacklevel=3)
        return file.name


def _in_notebook() -> bool:
    try:
        from IPython import get_ipython
    except ImportError:
        return False
    shell = get_ipython()
    return shell is not None and "IPKernelApp" in shell.config


def save_labels(path: Union[str, os.PathLike], skeletons: Mapping[int, Skeleton]) -> None:
    """Writes the skeletons of labels of one image into one file, .vtp, .graphml, .json, .csv, .glb,
    .html, .svg, .png or .mrk.json, or a .precomputed folder, as `bccskel labels` does. With `{label}`
    in its path one file per label, in any format; folders that `{label}` names are made.

    Raises ValueError for another ending, OSError where it cannot be written, NotImplementedError for
    pages and pictures of labels that a server has computed: they also show the objects.

    >>> import os, tempfile
    >>> import numpy as np, bccskel
    >>> bars = bccskel.skeletonize_labels(np.repeat(np.uint8([[[7]], [[9]]]), 30, axis=2))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_labels(os.path.join(folder, "bar-{label}.swc"), bars)
    ...     sorted(os.listdir(folder))
    ['bar-7.swc', 'bar-9.swc']
    """
    if not isinstance(skeletons, Mapping):
        raise TypeError("skeletons must be a dict of skeletons by label, got "
                        f"{type(skeletons).__name__}")
    for label, skeleton in skeletons.items():
        if not isinstance(label, numbers.Integral) or not 0 <= label < 2 ** 64:
            raise ValueError(f"labels must be whole numbers from 0 to 2**64 - 1, got {label!r}")
        if not isinstance(skeleton, Skeleton):
            raise TypeError(f"label {label} must have a Skeleton, got {type(skeleton).__name__}")
    ordered = sorted(skeletons.items())
    world, unit = (ordered[0][1].world, ordered[0][1].unit) if ordered else ("", "")
    note = _native.save_labels(path_text(path),
                               [(int(label), skeleton._outcome) for label, skeleton in ordered],
                               world, unit)
    if note:
        warnings.warn(f"{os.fspath(path)}: {note}", stacklevel=2)
