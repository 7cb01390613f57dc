#!/usr/bin/python3
"""Measures the command line on masks, file to graph, beside scikit-image's thinning alone, and beside
that with scipy's distances, which radii need.

Usage:
  tests/bench/masks_report.py BCCSKEL FOLDER [--repeat 3] [--output masks.md]

FOLDER holds the volumes of the test data (BCCSKEL_TEST_DATA/volume). Needs python3-skimage. Runs of
all programs on a volume take turns, each in a process of its own; the least of the runs counts.
"""

import argparse
import gzip
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

# What is foreground where not everything but zero is.
VOLUMES = {
    "airway_p4_chopped.nrrd": (), "aorta-final-levelset.mha": ("--below", "0"),
    "Al.100.vol": (), "cat10b.vol": (), "100_fiberform.tif": ("--threshold", "90"),
    "liver.inr.gz": ("--label", "127"), "lobster.vol": ("--threshold", "40"),
    "lobsterCroped2.nii.gz": ("--threshold", "40"), "neuron_28018323.nrrd": (),
    "neuron_28648864.nrrd": (), "neuron_28794499.nrrd": (),
    "poon2015_BBB_noLeakage_manualLabel_v2.tif": (),
    "santos2015_lowContrastVessels_labelsMarc.tif": (),
}

# Reads a mask and says the processor time of thinning it, and of thinning and distances.
THINNING = """
import sys, time
import numpy
from scipy.ndimage import distance_transform_edt
from skimage.morphology import skeletonize_3d
mask = numpy.load(sys.argv[1])
begin = time.process_time()
skeletonize_3d(mask)
thinned = time.process_time()
distance_transform_edt(mask)
print(thinned - begin, time.process_time() - begin)
"""

# Runs a command. A process of little memory of its own starts it, since Linux counts the peak of the
# process that calls fork() as the child's.
LAUNCHER = """
import os, sys, time
quiet = os.open(os.devnull, os.O_WRONLY)
read, write = os.pipe()
start = time.perf_counter()
child = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ,
                        file_actions=[(os.POSIX_SPAWN_DUP2, write, 1),
                                      (os.POSIX_SPAWN_DUP2, quiet, 2)])
os.close(write)
text = open(read).read()
_, status, usage = os.wait4(child, 0)
wall = time.perf_counter() - start
print(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss)
print(text, end="")
"""


class Run:
    """Seconds of the processor and the clock, and MiB at the peak. What thins prints its own."""

    def __init__(self, command, times_itself=False):
        ended = subprocess.run([sys.executable, "-S", "-c", LAUNCHER, *command], check=True,
                               stdout=subprocess.PIPE, text=True)
        facts, text = ended.stdout.split("\n", 1)
        code, self.cpu, self.wall, peak = map(float, facts.split())
        if code != 0:
            sys.exit(f"masks_report: {command} ended with {code:.0f}")
        self.peak = peak / 1024
        self.with_distances = 0.0
        if times_itself:
            self.cpu, self.with_distances = (float(word) for word in text.split())


def least(runs):
    best = runs[0]
    for run in runs:
        best.cpu, best.wall = min(best.cpu, run.cpu), min(best.wall, run.wall)
        best.peak = min(best.peak, run.peak)
        best.with_distances = min(best.with_distances, run.with_distances)
    return best


def mask_of(bccskel, path, rule, folder):
    """The foreground as a file of numpy: the voxels to which the branch image gives a branch."""
    image = folder / "branches.nrrd"
    subprocess.run([bccskel, "skeletonize", path, *rule, "--local", "--pruning", "none",
                    "--branch-image", image, "-o", folder / "graph.json"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    header, data = image.read_bytes().split(b"\n\n", 1)
    sizes = next(line for line in header.split(b"\n") if line.startswith(b"sizes:"))
    shape = [int(word) for word in sizes.split()[1:]]
    labels = numpy.frombuffer(gzip.decompress(data), "<u4").reshape(shape[::-1])
    numpy.save(folder / "mask.npy", labels > 0)
    return folder / "mask.npy", int((labels > 0).sum()), labels.size


def measure(bccskel, path, rule, repeat):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mask, voxels, box = mask_of(bccskel, path, rule, folder)
        ours = [bccskel, "skeletonize", path, *rule, "--local", "-o", folder / "graph.json"]
        runs = {"one": [], "two": [], "peer": []}
        for _ in range(repeat):
            runs["one"].append(Run([*ours, "--threads", "1"]))
            runs["two"].append(Run([*ours, "--threads", "2"]))
            runs["peer"].append(Run([sys.executable, "-c", THINNING, mask], times_itself=True))
        return voxels, box, {key: least(them) for key, them in runs.items()}


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def report(rows):
    lines = ["| mask | voxels | of its box | 1 thread: CPU ms | wall ms | MiB | 2 threads: wall ms |"
             " thinning of scikit-image: CPU ms | and distances | MiB | ratio | with distances |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    ratios, both = [], []
    for name, (voxels, box, runs) in rows.items():
        one, two, peer = runs["one"], runs["two"], runs["peer"]
        ratios.append(peer.cpu / one.cpu)
        both.append(peer.with_distances / one.cpu)
        lines.append(
            f"| {name} | {voxels:,} | {100 * voxels / box:.2g} % | {1e3 * one.cpu:.0f} | "
            f"{1e3 * one.wall:.0f} | {one.peak:.0f} | {1e3 * two.wall:.0f} | "
            f"{1e3 * peer.cpu:.0f} | {1e3 * peer.with_distances:.0f} | {peer.peak:.0f} | "
            f"{ratios[-1]:.1f} | {both[-1]:.1f} |")
    lines += ["", f"Ratios of processor times: geometric mean {geometric_mean(ratios):.1f}, least "
              f"{min(ratios):.1f}; with distances {geometric_mean(both):.1f} and {min(both):.1f}."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bccskel")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--output", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = {}
    for name, rule in VOLUMES.items():
        path = arguments.folder / name
        if path.exists():
            print(f"masks_report: {name}", file=sys.stderr, flush=True)
            rows[name] = measure(arguments.bccskel, path, rule, arguments.repeat)
    if not rows:
        sys.exit(f"masks_report: {arguments.folder} holds none of {', '.join(VOLUMES)}")
    text = report(rows)
    if arguments.output:
        arguments.output.write_text(text, encoding="utf-8")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
