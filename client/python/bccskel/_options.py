"""Options: the command line's, with underscores. The extension module parses them."""

from __future__ import annotations

import difflib
import numbers
from collections.abc import Mapping
from typing import Any, Iterable, Literal, Tuple, TypedDict, Union

import numpy as np

from . import _native


class SkeletonOptions(TypedDict, total=False):
    preset: Literal["neuron", "vessels", "airway", "materials", "cad"]
    denoise: int
    fill_cavities: bool
    cut_loops: float
    join_gaps: float
    min_component: int
    min_component_volume: float
    keep_largest: bool
    distance: Literal["chamfer", "chamfer-optimal", "euclidean"]
    pruning: Literal["significance", "length", "relative-length", "persistence", "none"]
    pruning_threshold: float
    tips: Literal["ridge", "as-thinned"]
    border: Literal["auto", "ends", "continues"]
    merge_junctions: float
    method: Literal["directional", "directional-alternating", "symmetric"]
    kind: Literal["curve", "surface", "kernel", "isthmus-curve"]
    stubble: Literal["keep-two", "literal", "none"]
    shell_width: float
    last_shell: int
    no_cleanup: bool
    root: Union[str, Tuple[float, float, float]]


class ConversionOptions(SkeletonOptions, total=False):
    label: Union[int, Iterable[int]]
    labels: Union[int, Iterable[int]]
    adjacency: Literal["26,6", "6,26"]
    voxel_points: Literal[2, 16]
    sampling: Literal["exact", "nearest", "trilinear"]
    density: float


class MaskOptions(ConversionOptions, total=False):
    range: Tuple[Union[float, None], Union[float, None]]
    threshold: float
    below: float
    invert: bool


class LabelsOptions(ConversionOptions, total=False):
    min_voxels: int


class MeshOptions(SkeletonOptions, total=False):
    points: int
    spacing: float
    fill: Literal["auto", "parity", "winding"]
    thin_parts: Literal["keep", "sample"]
    lattice_axes: Literal["shape", "world"]


class FileOptions(TypedDict, total=False):
    voxel_size: Union[float, Tuple[float, float, float]]
    unit: str
    channel: int
    time: int
    level: int
    series: Union[str, int]
    array: str
    raw_size: Tuple[int, int, int]
    raw_type: str
    raw_order: Literal["little", "big"]
    raw_header: int


_PLACES = ("root", "voxel_size", "raw_size")
"""Options of three numbers that go with the axes."""

_OTHER_NAMES = {"voxel_size": "spacing", "anisotropy": "spacing", "resolution": "spacing",
                "dust_threshold": "min_component", "min_size": "min_component"}
"""Names that users of other programs and of the command line expect."""

_OF_LABELS = {"min_component": "min_voxels"}


def texts_of(function: str, kind: str, options: Mapping[str, Any], to_xyz: list) -> list:
    """(name, text) for each option that is not None; no text for a flag that is set."""
    names = _native.option_names(kind)
    texts = []
    for name, value in options.items():
        if name not in names:
            near = _OTHER_NAMES.get(name)
            if near is None:
                near = next(iter(difflib.get_close_matches(name, names, 1, 0.7)), None)
            elif kind == "labels":
                near = _OF_LABELS.get(near, near)
            hint = f". Did you mean {near!r}?" if near else ""
            raise TypeError(f"{function}() got an unexpected keyword argument {name!r}{hint}")
        if value is None:
            continue
        if _native.is_flag(kind, name):
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"{name} must be True or False, got {value!r}")
            texts.append((name, None if value else "false"))
        elif name == "voxel_size" and isinstance(value, numbers.Real):
            texts.append((name, _text(name, value)))
        elif name in _PLACES and not isinstance(value, str):
            if np.shape(value) != (3,) or not _finite(value):
                raise ValueError(f"{name} must be 3 finite numbers, one per axis, got {value!r}")
            texts.append((name, _text(name, np.asarray(value)[to_xyz])))
        else:
            texts.append((name, _text(name, value)))
    return texts


def _finite(values: Any) -> bool:
    try:
        return bool(np.isfinite(np.asarray(values, float)).all())
    except (TypeError, ValueError):
        return False


def _text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    if value is None:
        return ""
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be a number or a text, got {value}")
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    try:
        return ",".join(_text(name, item) for item in value)
    except TypeError:
        raise TypeError(f"{name} must be a number, a text or several, got {value!r}") from None
