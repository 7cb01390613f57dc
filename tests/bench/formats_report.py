#!/usr/bin/python3
"""Measures how long writing a large net takes in each format.

Usage:
  PYTHONPATH=build/release/client/python tests/bench/formats_report.py [--lines 70] [FORMAT ...]

The object is a cubic grid of thin bars, `--lines` along each axis, five voxels apart: 70 make a graph
of 1,014,300 edges. Prints, for each format, the time, the processor time of all threads, and the size. Needs
python3-numpy.
"""

import argparse
import pathlib
import tempfile
import time

import bccskel
import numpy

PERIOD = 5  # voxels
FORMATS = ("precomputed", "csv", "obj", "swc", "vtp", "graphml", "json", "mrk.json", "glb", "html", "svg",
           "png")


def net_of(lines):
    """Bars of one voxel along every axis, which end in junctions."""
    side = PERIOD * (lines - 1) + 1
    mask = numpy.zeros((side, side, side), numpy.uint8)
    at = numpy.arange(0, side, PERIOD)
    everywhere = numpy.arange(side)
    for axis in range(3):
        mask[numpy.ix_(*(everywhere if axis == along else at for along in range(3)))] = 1
    return mask


def bytes_in(path):
    files = [path] if path.is_file() else path.rglob("*")
    return sum(file.stat().st_size for file in files)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--lines", type=int, default=70)
    parser.add_argument("formats", metavar="FORMAT", nargs="*", default=FORMATS)
    arguments = parser.parse_args()
    skeleton = bccskel.skeletonize(net_of(arguments.lines))
    print(f"{len(skeleton.edges):,} edges\n\n| format | s | CPU s | MB |\n|---|---|---|---|", flush=True)
    for ending in arguments.formats:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / f"net.{ending}"
            begin, begin_wall = time.process_time(), time.monotonic()
            skeleton.save(path)
            seconds, wall = time.process_time() - begin, time.monotonic() - begin_wall
            print(f"| {ending} | {wall:.1f} | {seconds:.1f} | {bytes_in(path) / 1e6:.1f} |", flush=True)


if __name__ == "__main__":
    main()
