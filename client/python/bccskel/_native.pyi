# Coordinates in the order x, y, z, arrays in the order [z, y, x], options as texts.
from typing import Any, Callable, Optional, Sequence

import numpy

__version__: str

_Options = Sequence[tuple[str, Optional[str]]]

class Placement:
    spacing: list[float]
    origin: list[float]
    direction: list[float]
    def __init__(
        self, spacing: Sequence[float], origin: Sequence[float], direction: Sequence[float]
    ) -> None: ...

class Endpoint:
    def __init__(
        self, address: str, token: str, tls: Sequence[str], plaintext_token: bool
    ) -> None: ...

class Server:
    def __init__(self, endpoint: Endpoint) -> None: ...

class Call:
    def __init__(
        self,
        server: Optional[Server],
        threads: int,
        timeout: float,
        progress: Optional[Callable[[int, int], Any]],
    ) -> None: ...

class Outcome:
    certificate: dict[str, Any]
    options: dict[str, Any]
    timings: dict[str, float]
    notes: list[str]
    warnings: list[str]
    voxels: int
    method: str
    algorithm_version: str
    object_points: int
    sha256: str
    def nodes(self) -> dict[str, Any]: ...
    def edges(self) -> dict[str, Any]: ...
    def sheets(self) -> dict[str, Any]: ...
    def order(self) -> Optional[dict[str, Any]]: ...
    def curve_image(self) -> numpy.ndarray: ...
    def branch_image(self) -> numpy.ndarray: ...
    def save(
        self, path: str, title: str, world: str, unit: str, swc_step: Optional[float]
    ) -> str: ...

def option_names(kind: str) -> list[str]: ...
def is_flag(kind: str, name: str) -> bool: ...
def is_mesh(path: str) -> bool: ...
def is_image(path: str) -> bool: ...
def skeletonize_mask(
    mask: numpy.ndarray, placement: Placement, options: _Options, call: Call
) -> Outcome: ...
def skeletonize_mesh(
    vertices: numpy.ndarray, faces: numpy.ndarray, options: _Options, call: Call
) -> Outcome: ...
def skeletonize_labels(
    image: numpy.ndarray, placement: Placement, options: _Options, call: Call
) -> dict[int, Outcome]: ...
def save_labels(
    path: str, labels: Sequence[tuple[int, Outcome]], world: str, unit: str
) -> None: ...
def read_image(
    path: str, options: _Options
) -> tuple[numpy.ndarray, Placement, str, str]: ...
def read_mesh(path: str) -> tuple[numpy.ndarray, numpy.ndarray]: ...
def describe_server(endpoint: Endpoint, timeout: float) -> dict[str, str]: ...
