"""Arrays and their placement in the world."""

from __future__ import annotations

import dataclasses
import functools
import os
from typing import Any

import numpy as np

from . import _native


@dataclasses.dataclass(eq=False)
class Image:
    """An image as `read()` returns it. numpy functions take it as its array.

    Comparisons and &, |, ~ give an Image in the same place: skeletonize(image == 3). All but `array`
    are in the order of its axes, z, y, x. `origin` is the center of voxel (0, 0, 0).
    """

    array: np.ndarray
    spacing: tuple
    origin: tuple
    direction: np.ndarray
    """Shape (3, 3); column n is the direction of the array's axis n."""
    unit: str = ""
    """The unit of coordinates: "mm", "um", ...; empty if the file does not state it."""
    world: str = ""
    """Where the world's axes point: "RAS", "LPS", ...; empty if the file does not state it."""
    name: str = "image"

    def __repr__(self) -> str:
        return f"<Image {self.name}: {self.array.shape} {self.array.dtype}, spacing {self.spacing}>"

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        array = self.array if dtype is None else self.array.astype(dtype)
        return array.copy() if copy and array is self.array else array

    @property
    def shape(self) -> tuple:
        return self.array.shape

    @property
    def dtype(self) -> np.dtype:
        return self.array.dtype

    @property
    def ndim(self) -> int:
        return self.array.ndim

    def _voxelwise(self, function: Any, *others: Any) -> Any:
        array = function(self.array, *map(np.asarray, others))
        return dataclasses.replace(self, array=array) if array.shape == self.shape else array

    def __eq__(self, other: Any) -> Any:
        return self._voxelwise(np.equal, other)

    def __ne__(self, other: Any) -> Any:
        return self._voxelwise(np.not_equal, other)

    def __lt__(self, other: Any) -> Any:
        return self._voxelwise(np.less, other)

    def __le__(self, other: Any) -> Any:
        return self._voxelwise(np.less_equal, other)

    def __gt__(self, other: Any) -> Any:
        return self._voxelwise(np.greater, other)

    def __ge__(self, other: Any) -> Any:
        return self._voxelwise(np.greater_equal, other)

    def __and__(self, other: Any) -> Any:
        return self._voxelwise(np.bitwise_and, other)

    def __or__(self, other: Any) -> Any:
        return self._voxelwise(np.bitwise_or, other)

    def __invert__(self) -> Any:
        return self._voxelwise(np.invert)

    def __bool__(self) -> bool:
        raise ValueError("an Image has no truth value; its array is .array")


@dataclasses.dataclass(eq=False)
class Mesh:
    """A triangle mesh as `read()` returns it."""

    vertices: np.ndarray
    """Shape (n, 3), x, y, z."""
    faces: np.ndarray
    """Shape (m, 3), indices of vertices."""
    name: str = "mesh"

    def __repr__(self) -> str:
        return f"<Mesh {self.name}: {len(self.vertices)} vertices, {len(self.faces)} faces>"


class Lattice:
    """The points of a body-centered cubic lattice as `read()` returns them of .exr and .bccb files.

    `skeletonize()` takes it in place of a mask.
    """

    def __init__(self, volume: Any, name: str = "lattice") -> None:
        """For internal use."""
        self._volume = volume
        self.name = name

    def __repr__(self) -> str:
        return f"<Lattice {self.name}: {len(self.points)} points>"

    @functools.cached_property
    def points(self) -> np.ndarray:
        """Shape (n, 3): x, y, z, all even or all odd."""
        return self._volume.points()

    @functools.cached_property
    def coordinates(self) -> np.ndarray:
        """World coordinates of the points, shape (n, 3), x, y, z."""
        placement = self._volume.placement
        steps = self.points * np.asarray(placement.spacing) / 2
        return np.asarray(placement.origin) + steps @ np.reshape(placement.direction, (3, 3)).T


class Frame:
    """The axes of an array and the placement of its voxels."""

    def __init__(self, axes: str, spacing: Any = None, origin: Any = None,
                 direction: Any = None) -> None:
        if not isinstance(axes, str) or sorted(axes) != ["x", "y", "z"]:
            raise ValueError(f"axes must be 'zyx', 'xyz' or another order of them, got {axes!r}")
        self.axes = axes
        self.spacing = _three("spacing", 1.0 if spacing is None else spacing)
        if not (self.spacing > 0).all():
            raise ValueError(f"spacing must be positive, got {spacing}")
        self.origin = _three("origin", 0.0 if origin is None else origin)
        self.direction = np.eye(3) if direction is None else np.asarray(direction, float)
        if self.direction.shape != (3, 3) or not np.allclose(
                self.direction.T @ self.direction, np.eye(3), atol=1e-3):
            raise ValueError("direction must be 3 perpendicular unit vectors, shape (3, 3)")

    @property
    def from_xyz(self) -> list:
        """The index of each axis of the array in x, y, z."""
        return ["xyz".index(axis) for axis in self.axes]

    @property
    def to_xyz(self) -> list:
        return [self.axes.index(axis) for axis in "xyz"]

    def placement(self) -> Any:
        order = self.to_xyz
        return _native.Placement(self.spacing[order].tolist(), self.origin[order].tolist(),
                                 self.direction[np.ix_(order, order)].ravel().tolist())

    def zyx(self, array: np.ndarray) -> np.ndarray:
        return array.transpose([self.axes.index(axis) for axis in "zyx"])


def path_text(path: Any) -> Any:
    """A path as the extension module takes it. A NUL would cut it short there."""
    text = os.fspath(path)
    if ("\0" if isinstance(text, str) else b"\0") in text:
        raise ValueError(f"{text!r}: a path must not contain NUL")
    return text


def _three(name: str, value: Any) -> np.ndarray:
    """Three finite numbers from three or one."""
    try:
        array = np.asarray(value, float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape not in ((), (3,)) or not np.isfinite(array).all():
        raise ValueError(f"{name} must be 3 finite numbers or one for all axes, got {value!r}")
    return np.broadcast_to(array, 3).copy()


def voxels_of(array: Any, name: str) -> np.ndarray:
    """An array of three axes with a type that the extension module takes, copied only where its
    type is another."""
    if isinstance(array, (str, os.PathLike)):
        raise TypeError(f"{name} must be an array, got a path: read({str(array)!r}) reads the file")
    if isinstance(array, Mesh):
        raise TypeError(f"{name} must be an array, got a Mesh: skeletonize_mesh() takes it")
    if hasattr(array, "dataobj"):
        raise TypeError(f"{name} must be an array, got an image of nibabel: np.asarray({name}.dataobj)"
                        " is its array, of axes='xyz'; read(path) also reads its place in the world")
    if array is None or (np.ndim(array) == 0 and np.asarray(array).dtype == object):
        kinds = ", an Image or a Lattice" if name == "mask" else " or an Image"
        raise TypeError(f"{name} must be an array of three axes{kinds}, got {type(array).__name__}")
    if isinstance(array, np.ma.MaskedArray):
        array = array.filled(0)
    array = np.asarray(array)
    if array.ndim != 3:
        hint = f": {name}[None] is a stack of one slice" if array.ndim == 2 else ""
        raise ValueError(f"{name} must have 3 axes, got shape {array.shape}{hint}")
    if array.size == 0:
        raise ValueError(f"{name} must not be empty, got shape {array.shape}")
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must hold booleans or real numbers, got dtype {array.dtype}")
    if array.dtype.kind == "b":
        return array.view(np.uint8)
    if array.dtype.kind == "f" and array.itemsize not in (4, 8):
        return array.astype(np.float32 if array.itemsize < 4 else np.float64)
    return array.astype(array.dtype.newbyteorder("="), copy=False)


def check_labels(labels: np.ndarray) -> None:
    """Raises ValueError for values that are no labels, with the place in the array's own axes."""
    if labels.dtype.kind == "u" or (labels.dtype.kind == "i" and labels.min() >= 0):
        return
    wrong = labels < 0
    if labels.dtype.kind == "f":
        wrong |= (labels >= 2.0 ** 64) | ((labels != np.trunc(labels)) & ~np.isnan(labels))
    if wrong.any():
        place = np.unravel_index(wrong.argmax(), wrong.shape)
        raise ValueError(f"voxel ({', '.join(str(n) for n in place)}) is {labels[place]:g}; "
                         "labels are whole numbers from 0 on")


def labels_for_sending(labels: np.ndarray) -> np.ndarray:
    """The same labels as a contiguous array of unsigned numbers. Needs: check_labels()."""
    if labels.dtype.kind == "f":
        labels = np.nan_to_num(labels, nan=0.0).astype(np.uint64)
    return np.ascontiguousarray(labels.astype(f"u{labels.itemsize}", copy=False))


def check_vertices(mesh: Any) -> None:
    """Raises TypeError for what is none, with the function that takes it."""
    if isinstance(mesh, (str, os.PathLike)):
        what = f"a path: read({os.fspath(mesh)!r}) reads the file"
    elif isinstance(mesh, (Image, Lattice)):
        what = f"{'an Image' if isinstance(mesh, Image) else 'a Lattice'}: skeletonize() takes it"
    elif mesh is None:
        what = "NoneType"
    else:
        return
    raise TypeError(f"vertices must be an array or a Mesh, got {what}")


def triangles_of(mesh: Any, faces: Any) -> tuple:
    """Checked vertices and triangles, for the extension module."""
    vertices = np.ascontiguousarray(mesh, dtype=np.float64)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        hint = ": skeletonize() takes masks" if vertices.ndim == 3 else ""
        raise ValueError(f"vertices must have shape (n, 3), got {vertices.shape}{hint}")
    if not np.isfinite(vertices).all():
        raise ValueError("vertices must be finite")
    faces = np.asarray(faces)
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
        raise ValueError("faces must be triangles, whole numbers of shape (m, 3), got shape "
                         f"{faces.shape} and dtype {faces.dtype}")
    if faces.size and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise ValueError(f"faces must be indices of the {len(vertices)} vertices, got "
                         f"{faces.min()} to {faces.max()}")
    if not faces.size:
        raise ValueError("faces must not be empty")
    return vertices, np.ascontiguousarray(faces, dtype=np.uint32)
