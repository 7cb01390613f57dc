"""Results whose figures are known, to be shown by `bccskel view`."""

import json


def edge(nodes, source, target, radii, points=None, **more):
    """A straight curve between two nodes, or one through these points."""
    start, end, last = nodes[source]["position"], nodes[target]["position"], len(radii) - 1
    points = points or [[a + (b - a) * n / last for a, b in zip(start, end)]
                        for n in range(last + 1)]
    length = sum(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5 for p, q in zip(points, points[1:]))
    straight = sum((a - b) ** 2 for a, b in zip(start, end)) ** 0.5
    figures = {"tortuosity": length / straight} if straight else {}
    return {"source": source, "target": target, "points": points, "curve": points, "radii": radii,
            "length": length, "mean_radius": sum(radii) / len(radii), "min_radius": min(radii),
            "max_radius": max(radii), **figures, **more}


def node(number, kind, position, component=0, radius=1):
    return {"id": number, "kind": kind, "position": position, "radius": radius,
            "component": component}


def document(nodes, edges, unit="mm"):
    topology = {"components": 1, "loops": 0, "cavities": 0}
    return {"nodes": nodes, "edges": edges, "unit": unit, "world": "RAS", "object_points": 1234,
            "placement": {"spacing": [1, 1, 1], "origin": [-60, -60, -60],
                          "direction": [1, 0, 0, 0, 1, 0, 0, 0, 1]},
            "certificate": {"input": topology, "skeleton": topology, "simple_points_left": 0},
            "sha256": "0" * 64}


def forest(count, columns=10):
    """Trees of three branches: two of length 4 that stay, and one of 2 that is pruned at its
    component's number + 1."""
    nodes, edges = [], []
    for n in range(count):
        x, y, first = 12 * (n % columns), 6 * (n // columns), 4 * n
        nodes += [node(first, "junction", [x, y, 0], n, radius=2),
                  node(first + 1, "end", [x - 4, y, 0], n),
                  node(first + 2, "end", [x + 4, y, 0], n),
                  node(first + 3, "end", [x, y + 2, 0], n)]
        edges += [edge(nodes, first, first + 1, [2, 2, 2, 2, 1]),
                  edge(nodes, first + 2, first, [1, 1, 1, 1, 2]),
                  edge(nodes, first, first + 3, [2, 1, 1], pruning_level=n + 1)]
    return document(nodes, edges)


def lasso():
    """A loop on a stem that is pruned at 1."""
    nodes = [node(0, "junction", [0, 0, 0], radius=0.5), node(1, "end", [0, -3, 0])]
    return document(nodes, [
        edge(nodes, 0, 0, [1] * 9, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0],
                                    [1, 2, 0], [0, 2, 0], [0, 1, 0], [0, 0, 0]]),
        edge(nodes, 0, 1, [1, 1, 1, 1], pruning_level=1)], "um")


def fork():
    """A stem with two twigs, one of which is pruned at 1."""
    nodes = [node(0, "junction", [0, 0, 0]), node(1, "end", [0, -3, 0]), node(2, "end", [2, 0, 0]),
             node(3, "end", [-2, 0, 0])]
    return document(nodes, [edge(nodes, 0, 1, [1, 1, 1, 1]),
                            edge(nodes, 0, 2, [1, 1, 1]),
                            edge(nodes, 0, 3, [1, 1, 1], pruning_level=1)])


def write(path, sample):
    path.write_text(json.dumps(sample))
    return path
