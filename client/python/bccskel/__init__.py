"""Skeletons of masks, label images and meshes: graphs of curves with radii.

The topology is kept, and every result carries the proof of it (`Skeleton.certificate`).

>>> import numpy as np
>>> import bccskel
>>> mask = np.zeros((9, 9, 40), bool)
>>> mask[2:7, 2:7, 2:38] = True
>>> skeleton = bccskel.skeletonize(mask, spacing=(2.0, 1.0, 1.0))
>>> len(skeleton.edges), skeleton.certificate["topology_kept"]
(1, True)
"""

import pkgutil

# The code that protoc generates for the interface is bccskel.v1, in a folder of its own.
__path__ = pkgutil.extend_path(__path__, __name__)

from ._compute import Client, read, skeletonize, skeletonize_labels, skeletonize_mesh
from ._image import Image, Lattice, Mesh
from ._native import __version__
from ._skeleton import Page, Skeleton, save_labels

__all__ = ["Client", "Image", "Lattice", "Mesh", "Page", "Skeleton", "__version__", "read", "save_labels",
           "skeletonize", "skeletonize_labels", "skeletonize_mesh"]
