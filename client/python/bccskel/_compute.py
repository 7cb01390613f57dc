"""Skeletons of arrays and meshes, in process or on a server."""

from __future__ import annotations

import contextlib
import numbers
import os
import pathlib
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Callable, ContextManager, Iterator, List, Optional, Tuple, Union

import numpy as np

from . import _native
from ._image import (Frame, Image, Lattice, Mesh, check_labels, check_vertices, labels_for_sending,
                     path_text, triangles_of, voxels_of)
from ._options import texts_of
from ._skeleton import Skeleton

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._options import FileOptions, LabelsOptions, MaskOptions, MeshOptions

_Path = Union[str, "os.PathLike[str]"]
_Progress = Optional[Callable[[int, int], Any]]

_SYSTEM_AUTHORITIES = "/etc/ssl/certs/ca-certificates.crt"


def _check_timeout(timeout: Optional[float]) -> None:
    if timeout is not None and not (isinstance(timeout, numbers.Real) and 0 < timeout <= 1e7):
        raise ValueError(f"timeout must be a positive number of seconds, got {timeout!r}")


def _call(server: Any, threads: int, timeout: Optional[float], progress: _Progress) -> Any:
    if not isinstance(threads, numbers.Integral) or not 0 <= threads <= 1024:
        raise ValueError(f"threads must be a whole number from 0 to 1024, got {threads!r}")
    _check_timeout(timeout)
    if progress is not None and not callable(progress):
        raise TypeError("progress must be a function of (done, total) or None, got "
                        f"{type(progress).__name__}")
    return _native.Call(server, int(threads), float(timeout or 0), progress)


def _frame(image: Any, axes: str, spacing: Any, origin: Any, direction: Any) -> Frame:
    if not isinstance(image, Image):
        return Frame(axes, spacing, origin, direction)
    if axes != "zyx":
        raise ValueError(f"the axes of an Image are 'zyx', got {axes!r}")
    return Frame("zyx", image.spacing if spacing is None else spacing,
                 image.origin if origin is None else origin,
                 image.direction if direction is None else direction)


def _unit(unit: Optional[str]) -> str:
    if unit is None:
        return ""
    if not isinstance(unit, str):
        raise TypeError(f"unit must be a text such as 'um', got {type(unit).__name__}")
    return _native.checked_unit(unit)


def _warn(skeleton: Skeleton) -> Skeleton:
    for warning in skeleton.warnings + skeleton.notes:
        warnings.warn(warning, stacklevel=4)
    return skeleton


def _lattice(server: Any, lattice: Lattice, placed: bool, threads: int, timeout: Optional[float],
             progress: Any, unit: str, options: Mapping[str, Any]) -> Skeleton:
    if placed:
        raise TypeError("a Lattice has a placement and accepts no spacing, origin, direction or axes")
    for name in ("points", "spacing", "fill", "thin_parts", "lattice_axes"):
        if name in options:
            raise TypeError(f"a Lattice accepts no option {name}")
    frame = Frame("xyz")
    texts = texts_of("skeletonize", "mesh", options, frame.to_xyz)
    outcome = _native.skeletonize_lattice(lattice._volume, texts,
                                          _call(server, threads, timeout, progress))
    return _warn(Skeleton(outcome, frame, title=lattice.name, unit=unit))


def _mask(server: Any, mask: Any, spacing: Any, origin: Any, direction: Any, axes: str,
          threads: int, timeout: Optional[float], progress: Any, unit: Optional[str],
          options: Mapping[str, Any]) -> Skeleton:
    named = _unit(unit)
    if isinstance(mask, Lattice):
        placed = axes != "zyx" or any(it is not None for it in (spacing, origin, direction))
        return _lattice(server, mask, placed, threads, timeout, progress, named, options)
    array = voxels_of(mask, "mask")
    frame = _frame(mask, axes, spacing, origin, direction)
    texts = texts_of("skeletonize", "mask", options, frame.to_xyz)
    outcome = _native.skeletonize_mask(frame.zyx(array), frame.placement(), texts,
                                       _call(server, threads, timeout, progress))
    return _warn(Skeleton(outcome, frame, title=getattr(mask, "name", None) or "mask",
                          voxels=True, image=mask, unit=named))


def _warn_of_no_labels(image: np.ndarray, all_wanted: bool) -> None:
    """Of voxels that are no labels, before the work."""
    nans = np.count_nonzero(np.isnan(image)) if image.dtype.kind == "f" else 0
    if nans == image.size or not image.any():
        warnings.warn(f"no voxel has a label: all are 0{' or NaN' if nans else ''}", stacklevel=4)
    elif nans:
        warnings.warn(f"{nans} {'voxel is' if nans == 1 else 'voxels are'} NaN, which counts as "
                      "background", stacklevel=4)
    threshold = _native.gray_threshold(image) if all_wanted else None
    if threshold is not None:
        warnings.warn("the values look like gray levels, not labels, and each value is an object; "
                      f"skeletonize(image, threshold={threshold:g}) takes the brighter voxels for "
                      "one (Otsu's threshold)", stacklevel=4)


def _labels_in(wanted: Any) -> List[int]:
    """The single labels that are asked for, not ranges such as '3-7'."""
    values = np.ravel(list(wanted) if isinstance(wanted, (set, frozenset, range)) else wanted)
    return [int(value) for value in values if isinstance(value, numbers.Real)]


def _labels(server: Any, image: Any, spacing: Any, origin: Any, direction: Any, axes: str,
            threads: int, timeout: Optional[float], progress: Any, unit: Optional[str],
            options: Mapping[str, Any]) -> dict:
    named = _unit(unit)
    array = voxels_of(image, "image")
    frame = _frame(image, axes, spacing, origin, direction)
    texts = texts_of("skeletonize_labels", "labels", options, frame.to_xyz)
    view = frame.zyx(array)
    wanted = options.get("labels", options.get("label"))
    _warn_of_no_labels(view, wanted is None)
    if server is not None:
        check_labels(array)
        view = labels_for_sending(view)
    call = _call(server, threads, timeout, progress)
    try:
        outcomes = _native.skeletonize_labels(view, frame.placement(), texts, call)
    except ValueError:
        check_labels(array)  # names the voxel in the order of these axes
        raise
    absent = [label for label in _labels_in(wanted) if label not in outcomes]
    if absent:
        fewer = " or fewer than min_voxels" if options.get("min_voxels") else ""
        names = ", ".join(map(str, absent[:10])) + (", ..." if len(absent) > 10 else "")
        warnings.warn(f"labels without voxels{fewer}: {names}", stacklevel=3)
    elif not outcomes and (array > 0).any():
        warnings.warn(f"no label has {options.get('min_voxels', 1)} voxels or more", stacklevel=3)
    skeletons = {label: Skeleton(outcome, frame, title=f"label {label}", voxels=True, label=label,
                                 image=image, unit=named)
                 for label, outcome in outcomes.items()}
    _warn_of_notes(skeletons)
    return skeletons


def _warn_of_notes(skeletons: Mapping[int, Skeleton]) -> None:
    """Notes on many labels would hide each other: warns of those on the first three."""
    noted = {label: skeleton.warnings + skeleton.notes for label, skeleton in skeletons.items()
             if skeleton.warnings or skeleton.notes}
    for label, notes in list(noted.items())[:3]:
        for note in notes:
            warnings.warn(f"label {label}: {note}", stacklevel=4)
    if len(noted) > 3:
        warnings.warn(f"there are notes on {len(noted) - 3} more labels: see `notes` of their "
                      "skeletons", stacklevel=4)


def _mesh(server: Any, vertices: Any, faces: Any, threads: int, timeout: Optional[float],
          progress: Any, unit: Optional[str], options: Mapping[str, Any]) -> Skeleton:
    title, named = "mesh", _unit(unit)
    check_vertices(vertices)
    if isinstance(vertices, Mesh):
        if faces is not None:
            raise TypeError("skeletonize_mesh() takes a Mesh or vertices and faces, not both")
        vertices, faces, title = vertices.vertices, vertices.faces, vertices.name
    elif faces is None:
        raise TypeError("skeletonize_mesh() needs faces beside vertices")
    frame = Frame("xyz")
    texts = texts_of("skeletonize_mesh", "mesh", options, frame.to_xyz)
    outcome = _native.skeletonize_mesh(*triangles_of(vertices, faces), texts,
                                       _call(server, threads, timeout, progress))
    return _warn(Skeleton(outcome, frame, title=title, unit=named))


class _Functions:
    """The functions of the package, computed in process or, by a Client, on its server."""

    _server: Any = None

    def _hints(self) -> ContextManager[None]:
        return contextlib.nullcontext()

    def skeletonize(self, mask: Union[ArrayLike, Image, Lattice],
                    spacing: Optional[ArrayLike] = None, origin: Optional[ArrayLike] = None,
                    direction: Optional[ArrayLike] = None, axes: str = "zyx", threads: int = 0,
                    timeout: Optional[float] = None, progress: _Progress = None,
                    unit: Optional[str] = None,
                    **options: Unpack[MaskOptions]) -> Skeleton:
        """The skeleton of a mask.

        mask: an array of three axes, of any real type and any strides, an `Image`, or a `Lattice`,
            whose coordinates are x, y, z. Nonzero voxels are the object; NaN is background. `threshold=`,
            `below=`, `range=` and `label=` select other voxels.
        spacing: the size of a voxel along each axis of the array, or one number; 1 by default.
        origin: the center of voxel (0, 0, 0), in the order of the axes; 0 by default.
        direction: shape (3, 3); column n is the direction of the array's axis n.
        axes: the order of the array's axes: 'zyx' or, as in nibabel, 'xyz'. Coordinates of the
            result are in the same order.
        threads: 0 means all of the machine. The result is the same for any number.
        timeout: seconds.
        progress: called with (shells done, all shells).
        unit: of lengths, such as 'um', for files and pages; by default that of an `Image`.
        options: those of `bccskel skeletonize` with underscores: method, kind, pruning,
            pruning_threshold, merge_junctions, adjacency, ... See its manual.

        Raises ValueError (shapes, values of options), TypeError (types, unknown options), MemoryError
        (more than the library's limits), TimeoutError; KeyboardInterrupt ends the work.

        >>> import numpy as np
        >>> z, y, x = np.indices((16, 40, 40)) - np.array([8, 20, 20])[:, None, None, None]
        >>> ring = np.hypot(np.hypot(x, y) - 12, z) < 4
        >>> skeleton = skeletonize(ring, spacing=0.5)
        >>> skeleton.certificate["skeleton"]
        {'components': 1, 'loops': 1, 'cavities': 0}
        >>> bool(abs(skeleton.lengths.sum() - 2 * np.pi * 6) < 2)
        True
        """
        with self._hints():
            return _mask(self._server, mask, spacing, origin, direction, axes, threads, timeout,
                         progress, unit, options)

    def skeletonize_labels(self, image: Union[ArrayLike, Image],
                           spacing: Optional[ArrayLike] = None,
                           origin: Optional[ArrayLike] = None,
                           direction: Optional[ArrayLike] = None, axes: str = "zyx",
                           threads: int = 0, timeout: Optional[float] = None,
                           progress: _Progress = None, unit: Optional[str] = None,
                           **options: Unpack[LabelsOptions]) -> dict[int, Skeleton]:
        """The skeletons of the labels of an image, by label; 0 and NaN are background.

        As `skeletonize()`, but `progress` is called with (labels done, all labels), and the options are
        those of `bccskel labels`: labels=[1, 7], min_voxels=100, ... Raises ValueError if no voxel
        has any of the given labels.

        >>> import numpy as np
        >>> image = np.zeros((8, 16, 30), np.uint16)
        >>> image[2:6, 2:6, 2:28] = 7
        >>> image[2:6, 6:10, 2:28] = 9
        >>> {label: skeleton.voxels for label, skeleton in skeletonize_labels(image).items()}
        {7: 416, 9: 416}
        """
        with self._hints():
            return _labels(self._server, image, spacing, origin, direction, axes, threads, timeout,
                           progress, unit, options)

    def skeletonize_mesh(self, vertices: Union[ArrayLike, Mesh],
                         faces: Optional[ArrayLike] = None, threads: int = 0,
                         timeout: Optional[float] = None, progress: _Progress = None,
                         unit: Optional[str] = None,
                         **options: Unpack[MeshOptions]) -> Skeleton:
        """The skeleton of the solid inside a triangle mesh.

        vertices: shape (n, 3), x, y, z; or a `Mesh`, then without faces.
        faces: shape (m, 3), indices of vertices.
        options: those of `bccskel skeletonize` with underscores. points=850_000 (default) or
            spacing=0.5 is the resolution; fill='parity' or 'winding' defines the inside (large
            holes need 'winding'); thin_parts='sample' leaves parts thinner than two lattice units
            as the lattice meets them, 'keep' (default) adds the points that they need to stay
            whole; lattice_axes='shape' (default) makes the result independent of the pose, 'world'
            keeps x, y, z.

        Otherwise as `skeletonize()`; coordinates of the result are x, y, z.

        >>> import numpy as np
        >>> box = np.array([[x, y, z] for x in (0, 9) for y in (0, 1) for z in (0, 1)], float)
        >>> faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        >>> skeletonize_mesh(box, faces, points=5000).certificate["topology_kept"]
        True
        """
        with self._hints():
            return _mesh(self._server, vertices, faces, threads, timeout, progress, unit, options)


_here = _Functions()
skeletonize = _here.skeletonize
skeletonize_labels = _here.skeletonize_labels
skeletonize_mesh = _here.skeletonize_mesh


def read(path: _Path, **options: Unpack[FileOptions]) -> Union[Image, Mesh, Lattice, Skeleton]:
    """An image (NIfTI, NRRD, TIFF, PNG, MetaImage, npy, npz, vol, ...) or a mesh (OBJ, STL, PLY, OFF,
    glTF, VTK polygon data, GIFTI, FreeSurfer) from a file, as the command line reads it; also
    compressed by gzip. A folder is read as OME-Zarr (to 0.5), a Zarr array, a Neuroglancer precomputed
    volume or one PNG or TIFF file per slice. A .json file is a result of the command line or of
    `Skeleton.save()`: a `Skeleton` that is shown without its object, coordinates x, y, z. A
    .exr or .bccb file is a `Lattice`.

    options, of images: channel and time (of TIFF and OME-Zarr), level (of folders),
        series (of DICOM), array (of npz), voxel_size=(z, y, x) or one number for cubes, unit
        ("um") instead of the file's, and
        raw_size=(z, y, x), raw_type, raw_order and raw_header for files without a header.

    Raises FileNotFoundError, PermissionError; ValueError for a file of another kind or with an
    encoding that is not supported.

    >>> import os, tempfile
    >>> import numpy as np
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "mask.npy")
    ...     np.save(path, np.ones((2, 3, 4), np.uint8))
    ...     image = read(path, voxel_size=(2, 1, 1))
    >>> image.array.shape, image.spacing
    ((2, 3, 4), (2.0, 1.0, 1.0))
    """
    try:
        return _read(path_text(path), options)
    except NotImplementedError as error:
        raise ValueError(str(error)) from None


def _read(name: str, options: Mapping[str, Any]) -> Union[Image, Mesh, Lattice, Skeleton]:
    texts = texts_of("read", "file", options, [2, 1, 0])
    if _native.is_mesh(name) and not texts:
        vertices, faces = _native.read_mesh(name)
        return Mesh(vertices, faces, pathlib.Path(name).name)
    ending = pathlib.Path(name).suffix.lower()
    if ending == ".json" and not texts:
        outcome, world, unit = _native.read_result(name)
        return Skeleton(outcome, Frame("xyz"), pathlib.Path(name).stem, unit=unit, world=world)
    if ending in (".exr", ".bccb") and not texts:
        return Lattice(_native.read_lattice(name), pathlib.Path(name).name)
    if not os.path.exists(name):
        raise FileNotFoundError(f"cannot open '{name}': No such file or directory")
    if not _native.is_image(name) and not texts:
        raise ValueError(f"{name}: read() takes images (.nii, .nrrd, .tif, .png, .mha, .inr, .npy, "
                         ".npz, .vol, .raw, ...), folders of slices, OME-Zarr and precomputed, "
                         "meshes (.obj, .stl, .ply, .off, .glb, .gltf, .vtk, .vtp, .gii, FreeSurfer), "
                         "results (.json) and lattices (.exr, .bccb)")
    array, placement, unit, world = _native.read_image(name, texts)
    direction = np.reshape(placement.direction, (3, 3))[::-1, ::-1]
    return Image(array, tuple(placement.spacing[::-1]), tuple(placement.origin[::-1]), direction,
                 unit, world, pathlib.Path(name).name)


def _pem(path: Optional[Union[str, os.PathLike]]) -> str:
    if path is None:
        return ""
    text = pathlib.Path(path).read_text()
    if not text.strip():
        raise ValueError(f"{path}: is empty")
    return text


class Client(_Functions):
    """The same functions, computed by a server.

    Meshes are filled in process. skeletonize_labels() takes no samplings, and its skeletons have no
    pages and no lattice points.

    address: 'HOST:PORT' or 'unix:PATH'.
    token: the access token, in visible ASCII; surrounding whitespace, such
        as the newline of a file, is removed.
    tls: None or False for no encryption; True to trust the authorities of this machine; the path
        of a file of authorities (PEM); or (authorities, certificate, key), three paths.
    plaintext_token: also send the token over a network without TLS.

    Nothing is sent until a method is called. Raises ConnectionError if no server is reached,
    PermissionError for a missing or wrong token.

    >>> client = Client("unix:/nowhere")
    >>> client
    Client('unix:/nowhere')
    """

    def __init__(self, address: str = "127.0.0.1:50051", token: Optional[str] = None,
                 tls: Union[bool, _Path, Tuple[_Path, _Path, _Path], None] = None,
                 plaintext_token: bool = False) -> None:
        if tls is True:
            tls = _SYSTEM_AUTHORITIES
        elif tls is False:
            tls = None
        paths = tuple(tls) if isinstance(tls, (tuple, list)) else (tls,)
        if len(paths) not in (1, 3) or not all(isinstance(path, (str, os.PathLike, type(None)))
                                               for path in paths):
            raise ValueError("tls must be None, True, a path or (authorities, certificate, key)")
        pems = [_pem(path) for path in paths] + [""] * (3 - len(paths))
        for name, text in (("address", address), ("token", token or "")):
            if not isinstance(text, str):
                raise TypeError(f"{name} must be a text, got {type(text).__name__}")
        if not isinstance(plaintext_token, (bool, np.bool_)):
            raise TypeError(f"plaintext_token must be True or False, got {plaintext_token!r}")
        self.address = address
        self._has_token, self._has_tls = bool(token), tls is not None
        # Checks types here, because the binding's error would show the token.
        try:
            self._endpoint = _native.Endpoint(os.fsencode(address),
                                              (token or "").encode("utf-8", "surrogatepass"), pems,
                                              bool(plaintext_token))
            self._server = _native.Server(self._endpoint)
        except ValueError as error:
            if "in the clear" not in str(error):
                raise
            raise ValueError(f"{error}: give tls=, or plaintext_token=True to send it so") from None

    def __repr__(self) -> str:
        return f"Client({self.address!r})"

    def __reduce__(self) -> Any:
        raise TypeError("a Client holds a connection and cannot be pickled: create one in each "
                        "process")

    @contextlib.contextmanager
    def _hints(self) -> Iterator[None]:
        """Names the arguments that an error asks for."""
        try:
            yield
        except PermissionError:
            if self._has_token:
                raise
            raise PermissionError("the server requires a token: give token= to Client") from None
        except ConnectionError as error:
            fault = _native.connection_fault(str(error), self.address, self._has_tls)
            hints = {_native.ConnectionFault.SERVER_HAS_NO_TLS:
                     "it has no TLS: omit tls= if the network is trusted",
                     _native.ConnectionFault.NOT_TRUSTED:
                     "give the authority that signed its certificate as tls=",
                     _native.ConnectionFault.MAY_WANT_TLS: "if it wants TLS, give tls= to Client"}
            hint = hints.get(fault, "start bccskel-server there")
            raise ConnectionError(f"server {self.address}: {error}; {hint}") from None

    def describe(self, timeout: float = 10.0) -> dict[str, str]:
        """{'server_version': ..., 'algorithm_version': ...}"""
        _check_timeout(timeout)
        with self._hints():
            return _native.describe_server(self._endpoint, float(timeout))
