import os
from typing import Any, Callable, Iterable, Literal, TypedDict, Union

import numpy.typing
from typing_extensions import Unpack

from ._image import Image as Image
from ._image import Lattice as Lattice
from ._image import Mesh as Mesh
from ._skeleton import Page as Page
from ._skeleton import Skeleton as Skeleton
from ._skeleton import save_labels as save_labels

__version__: str

_Array = numpy.typing.ArrayLike
_Triple = Union[float, tuple[float, float, float], _Array]
_Progress = Callable[[int, int], Any]
_Path = Union[str, os.PathLike[str]]

class _SkeletonOptions(TypedDict, total=False):
    preset: Literal["neuron", "vessels", "airway", "materials", "cad"]
    denoise: int
    fill_cavities: bool
    cut_loops: float
    min_component: int
    min_component_volume: float
    keep_largest: bool
    distance: Literal["chamfer", "chamfer-optimal", "euclidean"]
    pruning: Literal["significance", "length", "relative-length", "persistence", "none"]
    pruning_threshold: float
    tips: Literal["ridge", "as-thinned"]
    border: Literal["ends", "continues"]
    merge_junctions: float
    method: Literal["directional", "directional-alternating", "symmetric"]
    kind: Literal["curve", "surface", "kernel", "isthmus-curve"]
    stubble: Literal["keep-two", "literal", "none"]
    shell_width: float
    last_shell: int
    no_cleanup: bool
    root: Union[str, tuple[float, float, float]]

class _ConversionOptions(_SkeletonOptions, total=False):
    label: Union[int, Iterable[int]]
    labels: Union[int, Iterable[int]]
    adjacency: Literal["26,6", "6,26"]
    voxel_points: Literal[2, 16]
    sampling: Literal["exact", "nearest", "trilinear"]
    density: float

class _MaskOptions(_ConversionOptions, total=False):
    range: tuple[Union[float, None], Union[float, None]]
    threshold: float
    below: float
    invert: bool

class _LabelsOptions(_ConversionOptions, total=False):
    min_voxels: int

class _MeshOptions(_SkeletonOptions, total=False):
    points: int
    spacing: float
    fill: Literal["auto", "parity", "winding"]
    thin_parts: Literal["keep", "sample"]
    lattice_axes: Literal["shape", "world"]

class _FileOptions(TypedDict, total=False):
    voxel_size: tuple[float, float, float]
    channel: int
    time: int
    level: int
    series: Union[str, int]
    array: str
    raw_size: tuple[int, int, int]
    raw_type: str
    raw_order: Literal["little", "big"]
    raw_header: int

def skeletonize(
    mask: Union[_Array, Image, Lattice],
    spacing: Union[_Triple, None] = None,
    origin: Union[_Triple, None] = None,
    direction: Union[_Array, None] = None,
    axes: str = "zyx",
    threads: int = 0,
    timeout: Union[float, None] = None,
    progress: Union[_Progress, None] = None,
    **options: Unpack[_MaskOptions],
) -> Skeleton: ...
def skeletonize_labels(
    image: Union[_Array, Image],
    spacing: Union[_Triple, None] = None,
    origin: Union[_Triple, None] = None,
    direction: Union[_Array, None] = None,
    axes: str = "zyx",
    threads: int = 0,
    timeout: Union[float, None] = None,
    progress: Union[_Progress, None] = None,
    **options: Unpack[_LabelsOptions],
) -> dict[int, Skeleton]: ...
def skeletonize_mesh(
    vertices: Union[_Array, Mesh],
    faces: Union[_Array, None] = None,
    threads: int = 0,
    timeout: Union[float, None] = None,
    progress: Union[_Progress, None] = None,
    **options: Unpack[_MeshOptions],
) -> Skeleton: ...
def read(path: _Path, **options: Unpack[_FileOptions]) -> Union[
    Image, Mesh, Lattice, Skeleton
]: ...

class Client:
    address: str
    def __init__(
        self,
        address: str = "127.0.0.1:50051",
        token: Union[str, None] = None,
        tls: Union[bool, _Path, tuple[_Path, _Path, _Path], None] = None,
        plaintext_token: bool = False,
    ) -> None: ...
    def describe(self, timeout: float = 10.0) -> dict[str, str]: ...
    def skeletonize(
        self,
        mask: Union[_Array, Image, Lattice],
        spacing: Union[_Triple, None] = None,
        origin: Union[_Triple, None] = None,
        direction: Union[_Array, None] = None,
        axes: str = "zyx",
        threads: int = 0,
        timeout: Union[float, None] = None,
        progress: Union[_Progress, None] = None,
        **options: Unpack[_MaskOptions],
    ) -> Skeleton: ...
    def skeletonize_labels(
        self,
        image: Union[_Array, Image],
        spacing: Union[_Triple, None] = None,
        origin: Union[_Triple, None] = None,
        direction: Union[_Array, None] = None,
        axes: str = "zyx",
        threads: int = 0,
        timeout: Union[float, None] = None,
        progress: Union[_Progress, None] = None,
        **options: Unpack[_LabelsOptions],
    ) -> dict[int, Skeleton]: ...
    def skeletonize_mesh(
        self,
        vertices: Union[_Array, Mesh],
        faces: Union[_Array, None] = None,
        threads: int = 0,
        timeout: Union[float, None] = None,
        progress: Union[_Progress, None] = None,
        **options: Unpack[_MeshOptions],
    ) -> Skeleton: ...
