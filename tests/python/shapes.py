"""Small objects for the tests of this folder."""

import numpy


def crossing_bars():
    """A bar with an arm, and a ring; index (z, y, x)."""
    mask = numpy.zeros((30, 40, 50), bool)
    mask[4:9, 8:13, 3:47] = True
    mask[4:9, 8:36, 20:25] = True
    z, y, x = numpy.indices(mask.shape)
    mask[numpy.hypot(numpy.hypot(x - 35, y - 25) - 9, z - 20) < 3.5] = True
    return mask


def ball(radius):
    z, y, x = numpy.ogrid[(slice(-radius - 1, radius + 2),) * 3]
    return x * x + y * y + z * z <= radius * radius


def box_mesh(size=(9.0, 1.0, 1.5)):
    """(vertices, faces)"""
    corners = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return corners * numpy.array(size), numpy.array(faces)
