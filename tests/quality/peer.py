"""scikit-image's skeletonize_3d on the cubic grid, with as many voxels as the objects have points.

Its lengths are turned into lattice units of an object with as many points on the bcc grid.
"""

import json
import subprocess
import sys
import time

import numpy as np

import tables

# Edge of a voxel in lattice units: a lattice point stands for four cubic units.
VOXEL = 4 ** (1 / 3)
# Points on either side that the smoothed curve is the mean of, all at the same weight.
REACH = 4


def name():
    import skimage
    return f"scikit-image {skimage.__version__}, skeletonize_3d"


def neighbors_of(points):
    """For each point, the positions of its neighbors among the 26 around it."""
    at = {tuple(p): n for n, p in enumerate(points)}
    offsets = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z]
    return [[at[q] for q in ((p[0] + x, p[1] + y, p[2] + z) for x, y, z in offsets) if q in at]
            for p in points.tolist()]


def clusters(members, neighbors):
    """How many connected groups the points in `members` form."""
    left, count = set(members), 0
    while left:
        count += 1
        stack = [left.pop()]
        while stack:
            found = [q for q in neighbors[stack.pop()] if q in left]
            left.difference_update(found)
            stack += found
    return count


def smooth(points, neighbors):
    """The mean of the points within REACH steps, fewer near ends, so that ends stay."""
    places = np.empty(points.shape)
    for n in range(len(points)):
        rings, seen = [[n]], {n}
        for _ in range(REACH):
            ring = {q for p in rings[-1] for q in neighbors[p]} - seen
            if len(ring) < 2:
                break
            seen |= ring
            rings.append(list(ring))
        places[n] = points[[p for ring in rings for p in ring]].mean(axis=0)
    return places


def offsets(places, line):
    """Mean, largest and bias of the ways from the center line, in voxels."""
    best = np.full(len(places), np.inf)
    ways = np.zeros(places.shape)
    for piece in line:
        a, b = np.array(piece[:3]), np.array(piece[3:6])
        axis = b - a
        t = np.clip((places - a) @ axis / (axis @ axis), 0, 1)
        way = places - a - t[:, None] * axis
        length = np.linalg.norm(way, axis=1)
        nearer = length < best
        best[nearer], ways[nearer] = length[nearer], way[nearer]
    return {"mean": VOXEL * best.mean(), "largest": VOXEL * best.max(),
            "bias": VOXEL * float(np.linalg.norm(ways.mean(axis=0)))}


def match_tips(ends, tips):
    """As MatchTips() of measure.cc."""
    pairs = sorted((float(np.linalg.norm(end - np.array(tip[3:6]))), t, e)
                   for t, tip in enumerate(tips) for e, end in enumerate(ends))
    tips_left, ends_left, gaps = set(range(len(tips))), set(range(len(ends))), []
    for gap, t, e in pairs:
        if t in tips_left and e in ends_left and gap <= 2 * tips[t][7] + 8 / VOXEL:
            tips_left.discard(t)
            ends_left.discard(e)
            gaps.append(VOXEL * gap)
    return {"found": len(gaps), "lost": len(tips_left), "spurious": len(ends_left),
            "mean_gap": float(np.mean(gaps)) if gaps else 0, "largest_gap": max(gaps, default=0)}


def flipped(voxels, fraction, seed):
    """Flips a share of the voxels on either side of the boundary: plain noise."""
    from scipy import ndimage
    inner = voxels & ~ndimage.binary_erosion(voxels)
    outer = ~voxels & ndimage.binary_dilation(voxels)
    chosen = np.random.default_rng(seed).random(voxels.shape) < fraction
    return voxels ^ ((inner | outer) & chosen)


def judge(truth, voxels, noise):
    from skimage.morphology import skeletonize_3d
    started = time.thread_time()
    skeleton = skeletonize_3d(voxels)
    milliseconds = 1000 * (time.thread_time() - started)
    points = np.argwhere(skeleton)[:, ::-1]
    row = {"figure": truth["figure"], "method": "scikit-image", "noise": noise,
           "turn": truth["turn"], "tips": len(truth["tips"]), "forks": truth["forks"],
           "known_line": bool(truth["line"]), "empty": len(points) == 0,
           "milliseconds": milliseconds}
    neighbors = neighbors_of(points)
    ends = [points[n] for n in range(len(points)) if len(neighbors[n]) == 1]
    row.update(match_tips(ends, truth["tips"]), ends=len(ends), junctions=clusters(
        [n for n in range(len(points)) if len(neighbors[n]) > 2], neighbors))
    if truth["line"] and len(points) > 0:
        row["raw"] = offsets(points.astype(float), truth["line"])
        row["smooth"] = offsets(smooth(points.astype(float), neighbors), truth["line"])
    return row


def voxels_of(command):
    """What a study prints of each object, and its voxels."""
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        while line := process.stdout.readline():
            truth = json.loads(line)
            count = int(np.prod(truth["shape"]))
            data = process.stdout.read((count + 7) // 8)
            bits = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
            yield truth, bits[:count].reshape(truth["shape"]).astype(bool)


def measure(program, arguments):
    command = [program, "voxels", "--points", str(arguments.points), "--turns",
               str(arguments.turns)]
    rows = []
    for truth, voxels in voxels_of(command):
        for noise in tables.NOISES:
            rows.append(judge(truth, flipped(voxels, noise, truth["turn"]), noise))
        print(f"peer: {truth['figure']}", file=sys.stderr)
    return rows


def missed_parts(voxels, points, radii, spacing):
    """As CountMissedParts() of hair.cc."""
    from scipy import ndimage
    left = voxels.copy()
    edge = float(np.prod(spacing)) ** (1 / 3)
    for point, radius in zip(points, radii + 4 * edge):
        low = np.maximum(np.ceil(point - radius / spacing).astype(int), 0)
        high = np.minimum(np.floor(point + radius / spacing).astype(int) + 1, voxels.shape)
        box = tuple(slice(a, b) for a, b in zip(low, high))
        ways = np.ogrid[box]
        square = sum(((way - p) * s / radius) ** 2 for way, p, s in zip(ways, point, spacing))
        left[box] &= square > 1
    groups, _ = ndimage.label(left, np.ones((3, 3, 3)))
    return int((np.bincount(groups.ravel())[1:] > 20).sum())


def measure_masks(program, folder):
    """Ends and missed parts of the real masks; radii are distances to the nearest background."""
    from scipy import ndimage
    from skimage.morphology import skeletonize_3d
    rows = []
    for truth, voxels in voxels_of([program, "real-voxels", "--data", folder]):
        some = np.argwhere(voxels)
        low, high = some.min(axis=0), some.max(axis=0) + 1
        voxels = np.pad(voxels[tuple(slice(a, b) for a, b in zip(low, high))], 1)
        spacing = np.array(truth["spacing"])
        started = time.thread_time()
        points = np.argwhere(skeletonize_3d(voxels))
        seconds = time.thread_time() - started
        radii = ndimage.distance_transform_edt(voxels, sampling=spacing)[tuple(points.T)]
        ends = sum(1 for near in neighbors_of(points) if len(near) == 1)
        rows.append({"mask": truth["mask"], "ends": ends, "seconds": seconds,
                     "missed": missed_parts(voxels, points, radii, spacing)})
        print(f"peer: {truth['mask']}", file=sys.stderr)
    return rows
