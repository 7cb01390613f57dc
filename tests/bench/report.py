#!/usr/bin/python3
"""Measures the engine against its targets and prints the result as markdown.

Needs a release build and docker/packages/bench.txt. Usage:
  tests/bench/report.py BUILD [--quick] [--large] [--output report.md] [--plot growth.png]
README.md in this folder says what each figure means.
"""

import argparse
import json
import os
import pathlib
import platform
import random
import re
import subprocess
import sys
import time

import numpy

import report_tables as tables
from report_tables import COMPACT, LARGE, OBJECTS, Rows

HERE = pathlib.Path(__file__).resolve().parent

# Repetitions by size; sizes from 64M on are asked for with --large.
FULL = {10_000: 51, 100_000: 31, 850_000: 21, 8_000_000: 9, 64_000_000: 5}
QUICK = {10_000: 11, 100_000: 11, 850_000: 7, 8_000_000: 3, 64_000_000: 1}
# Objects too large for the reference, which has a byte for each coordinate of the box.
REFERENCE_SIZES = {"thin-tubes": 10_000, "tubes": 850_000, "tree": 850_000}


class Programs:
    def __init__(self, build):
        bench = pathlib.Path(build) / "tests" / "bench"
        self.reference = str(bench / "bccskel_reference_digest")
        self.cubic = str(bench / "bccskel_cubic_object")
        self.command = str(pathlib.Path(build) / "client" / "cli" / "bccskel")
        self.cache = (pathlib.Path(build) / "CMakeCache.txt").read_text()

    def cached(self, key):
        found = re.search(rf"^{key}:\w+=(.*)$", self.cache, re.MULTILINE)
        return found.group(1) if found else "unknown"


def say(text):
    print(f"report: {text}", file=sys.stderr, flush=True)


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def bench_core(programs, name, points, threads, *options):
    return json.loads(output_of(
        programs.command, "bench", "core", "--shape", name, "--points", str(points),
        "--threads", str(threads), "--repeat", "1", "--json", *options))


def measure_rows(programs, rows, keys, repetitions):
    """The rows take turns in random order, so that a disturbance affects all of them alike."""
    turns = keys * repetitions
    random.shuffle(turns)
    for key in turns:
        name, points, threads, isa = key
        rows.add(key, bench_core(programs, name, points, threads, "--isa", isa))


def supported_sets(programs):
    described = output_of(programs.command, "bench", "core", "--help").decode()
    return re.search(r"--isa (\S+)", described).group(1).split("|")


def measure_engine(programs, sizes, repetitions):
    rows = Rows(supported_sets(programs))
    for points in sizes:
        say(f"engine, {points:,} points")
        keys = [(name, points, threads, rows.best) for name in OBJECTS for threads in (1, 2)]
        if 100_000 <= points <= 1_000_000:
            keys += [(name, points, 1, isa) for name in COMPACT for isa in rows.sets[1:]]
        measure_rows(programs, rows, keys, repetitions[points])
    return rows


def measure_under_load(programs, best, repetitions):
    """Two processes that never sleep, besides the engine."""
    say("engine, beside two busy processes")
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        rows = Rows([best])
        keys = [(name, 850_000, threads, best) for name in COMPACT for threads in (1, 2)]
        measure_rows(programs, rows, keys, repetitions)
        return rows
    finally:
        for process in busy:
            process.kill()
            process.wait()


def measure_memory(programs, points):
    """A process for each object, so that none finds memory of the one before."""
    say(f"memory, {points:,} points")
    return {name: bench_core(programs, name, points, 1) for name in OBJECTS}


def cubic_object(programs, name, points):
    header, bits = output_of(programs.cubic, name, str(points)).split(b"\n", 1)
    nx, ny, nz, _ = (int(word) for word in header.split())
    voxels = numpy.unpackbits(numpy.frombuffer(bits, numpy.uint8), bitorder="little")
    return voxels[:nx * ny * nz].reshape(nz, ny, nx)


def measure_scikit_image(programs, quick):
    from skimage.morphology import skeletonize_3d
    plan = [("ball", 850_000, 3), ("torus", 850_000, 3), ("tree", 850_000, 1)]
    if not quick:
        plan += [("ball", 8_000_000, 1), ("torus", 8_000_000, 1)]
    measured = {}
    for name, points, repetitions in plan:
        say(f"scikit-image, {name}, {points:,} points")
        voxels = cubic_object(programs, name, points)
        times = []
        for _ in range(repetitions):
            start = time.perf_counter()
            skeletonize_3d(voxels)
            times.append(time.perf_counter() - start)
        measured[name, points] = {"seconds": times, "points": int(voxels.sum()),
                                  "box": voxels.size}
    return measured


def check_digests(programs, rows, limit):
    """Each object has one digest in all its rows, and where affordable it is the reference's."""
    checks = []
    for name, points in sorted({key[:2] for key in rows.runs}):
        digests = {run["sha256"] for key, runs in rows.runs.items() if key[:2] == (name, points)
                   for run in runs}
        expected = None
        if points <= min(limit, REFERENCE_SIZES.get(name, limit)):
            say(f"reference, {name}, {points:,} points")
            expected = output_of(programs.reference, name, str(points)).decode().strip()
        same = len(digests) == 1 and (expected is None or digests == {expected})
        checks.append((name, points, expected is not None, same))
    return checks


def processor():
    found = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    return found.group(1) if found else platform.machine()


def revision():
    try:
        return output_of("git", "-C", str(HERE), "describe", "--always", "--dirty").decode().strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def context_lines(programs, rows, loads, seconds):
    compiler = output_of(programs.cached("CMAKE_CXX_COMPILER"), "--version").decode().split("\n")[0]
    import skimage
    quiet = "" if max(loads[0], 0) < 0.5 else " **The machine was not quiet: trust ratios alone.**"
    return [f"- machine: {processor()}, {os.cpu_count()} processors, "
            f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.0f} GiB, "
            f"{platform.system()} {platform.release().split('-')[0]}",
            f"- instruction sets: {', '.join(rows.sets)}",
            f"- compiler: {compiler}, {programs.cached('CMAKE_BUILD_TYPE')}; revision {revision()}",
            f"- scikit-image {skimage.__version__}, Python {platform.python_version()}",
            f"- load: {loads[0]:.2f} before, {loads[1]:.2f} after (this program counts).{quiet}",
            f"- date: {time.strftime('%Y-%m-%d', time.gmtime())}, {seconds / 60:.1f} minutes"]


def report(arguments):
    programs = Programs(arguments.build)
    repetitions = QUICK if arguments.quick else FULL
    sizes = [n for n in repetitions if n < LARGE or arguments.large]
    start, load_before = time.monotonic(), os.getloadavg()[0]
    rows = measure_engine(programs, sizes, repetitions)
    loaded = measure_under_load(programs, rows.best, repetitions[850_000])
    memory = measure_memory(programs, 8_000_000)
    scikit = measure_scikit_image(programs, arguments.quick)
    checks = check_digests(programs, rows, 100_000 if arguments.quick else sizes[-1])
    loads = (load_before, os.getloadavg()[0])
    tables.plot_growth(rows, sizes, arguments.plot)
    targets = tables.all_targets(rows, loaded, memory, scikit, checks, sizes)
    met = sum(1 for t in targets if t.met)
    judged = sum(1 for t in targets if t.met is not None)
    lines = ["# Speed and memory", ""]
    lines += context_lines(programs, rows, loads, time.monotonic() - start)
    lines += ["", f"## Targets: {met} of {judged} met; {len(targets) - judged} not measured", "",
              *tables.target_table(targets)]
    lines += ["", "## Warm runs", "", *tables.time_table(rows)]
    lines += ["", "## Cold runs and memory, one thread", "", *tables.cold_table(memory)]
    lines += ["", "## Growth", "", f"![time over points]({pathlib.Path(arguments.plot).name})", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", help="folder of a release build")
    parser.add_argument("--quick", action="store_true", help="few repetitions, in three minutes")
    parser.add_argument("--large", action="store_true", help="64M points, too; half an hour")
    parser.add_argument("--output", help="markdown file (default: standard output)")
    parser.add_argument("--plot", default="growth.png", help="PNG or SVG (default: growth.png)")
    arguments = parser.parse_args()
    text = report(arguments)
    if arguments.output:
        pathlib.Path(arguments.output).write_text(text, encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
