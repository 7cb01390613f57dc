#!/usr/bin/python3
"""Measures how good skeletons are and prints a report as markdown.

Usage: report.py BUILD_FOLDER [--output report.md] [--plot offsets.png] [--points N] [--turns N]
                 [--data FOLDER] [--without-peer]
"""

import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import time

import peer
import tables
import wild_tables

MESHES = ["aorta-surface.stl", "armadillo_86k.ply", "bunny_hr.obj.gz", "cactus.off", "elephant.off",
          "fertility.off", "hand.off", "horse.ply", "knot2.off", "scorpion.ply", "spot.obj"]


def rows_of(program, study, arguments, *more):
    """What a study prints, a dictionary a line."""
    started = time.monotonic()
    command = [program, study, "--points", str(arguments.points), "--turns", str(arguments.turns),
               "--json", *more]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    print(f"{study} {' '.join(more)}: {time.monotonic() - started:.0f} s", file=sys.stderr)
    return [json.loads(line) for line in text.splitlines()]


def mesh_rows(program, arguments):
    rows = []
    for name in MESHES:
        for path in pathlib.Path(arguments.data or os.devnull).rglob(name):
            rows += rows_of(program, "mesh", arguments, "--data", str(path))
    return rows


def wild_report(program, arguments):
    wild = []
    for points, turns in ((arguments.points, arguments.turns), (8.5 * arguments.points, 1)):
        size = argparse.Namespace(points=int(points), turns=turns)
        wild += rows_of(program, "wild", size, "--half", "judge", "--as", "bcc,mask", "--noise",
                        "0,2,5,10")
    lengths = rows_of(program, "spine-lengths", arguments)
    slices = rows_of(program, "thick-slices", arguments)
    cuts = rows_of(program, "cut-limbs", arguments)
    faces = rows_of(program, "image-faces", arguments, "--half", "judge")
    if not arguments.data:
        return wild_tables.report(wild, lengths, slices, cuts, faces, [], [], [], {})
    place = ("--data", arguments.data)
    sizes = ",".join(str(int(n * arguments.points)) for n in (1, 8.5, 40))
    meshes = rows_of(program, "meshes", argparse.Namespace(points=sizes, turns=6), *place)
    masks = rows_of(program, "real-masks", arguments, *place)
    changed = {words: rows_of(program, "real-masks", arguments, *words.split(), *place)
               for words in wild_tables.MASK_OPTIONS}
    others = [] if arguments.without_peer else peer.measure_masks(program, arguments.data)
    return wild_tables.report(wild, lengths, slices, cuts, faces, meshes, masks, others, changed)


def machine():
    name = "unknown processor"
    for line in open("/proc/cpuinfo", encoding="utf-8"):
        if line.startswith("model name"):
            name = line.split(":", 1)[1].strip()
            break
    return f"{name}, {os.cpu_count()} processors, {platform.system()}"


def heading(arguments, peer_name):
    return ["# Quality of skeletons", "",
            f"Objects of about {arguments.points:,} points, {arguments.turns} random rotations of "
            "each figure. All lengths are in lattice units: half the edge of the cubic cell, so a "
            "voxel of a cubic grid with as many samples is 1.587 wide. Settings are the defaults, "
            "except for the method and the distance that a table names.",
            "",
            f"Machine: {machine()}. The results do not depend on it. The peer is {peer_name}.",
            ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--output", default="/dev/stdout")
    parser.add_argument("--plot")
    parser.add_argument("--points", type=int, default=100000)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--data", default="")
    parser.add_argument("--without-peer", action="store_true")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.build) / "tests/quality/bccskel_quality")
    figures = rows_of(program, "figures", arguments)
    others = [] if arguments.without_peer else peer.measure(program, arguments)
    rotations = rows_of(program, "rotations", arguments)
    reconstruction = rows_of(program, "reconstruction", arguments)
    meshes = mesh_rows(program, arguments)
    lines = heading(arguments, "none" if arguments.without_peer else peer.name())
    lines += tables.report(figures, others, rotations, reconstruction, meshes,
                           wild_report(program, arguments))
    pathlib.Path(arguments.output).write_text("\n".join(lines) + "\n", encoding="utf-8")
    if arguments.plot:
        tables.plot(figures, others, arguments.plot)


if __name__ == "__main__":
    main()
