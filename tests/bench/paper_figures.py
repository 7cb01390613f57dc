#!/usr/bin/python3
"""Figures 11 and 12 of the paper again: time over growing resolution, and a table of models.

Needs a release build and the packages of docker/packages/bench.txt and demo.txt. Usage:
  tests/bench/paper_figures.py BUILD [--quick] [--output FOLDER]      (default: tests/bench/paper)
Writes README.md, growth.png and a picture of each model.
"""

import argparse
import collections
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import report

HERE = pathlib.Path(__file__).resolve().parent
FETCH = HERE.parent.parent / "docker" / "fetch-models"

# Of the Debian package libcgal-demo, with surfaces that are closed and do not cross; and shapes of
# `bccskel generate`.
MESHES = ("elephant", "armadillo", "dino", "triceratops", "diplodocus", "hand", "cactus", "bear",
          "knot2", "turbine")
SHAPES = ("torus", "horse", "tree")
GROWING = MESHES[:3]  # as in the paper, the first three
TABLE_POINTS = 850_000
GROWTH_POINTS = tuple(25_000 * 2**n for n in range(8))  # to 3.2 million
PICTURE_SIZE = "640x480"
METHODS = ("directional", "symmetric")

# What the text of the paper says of objects of about 850,000 points, in milliseconds: "less than
# one second" on one thread of an Intel dual-core processor, "approximately a half second" on two.
PAPER_MS = {1: 1000, 2: 500}

Model = collections.namedtuple("Model", "name summary runs")


class Commands:
    def __init__(self, build, work):
        self.command = str(pathlib.Path(build) / "client" / "cli" / "bccskel")
        self.work = pathlib.Path(work)

    def run(self, *arguments):
        ended = subprocess.run([self.command, *map(str, arguments)], check=True,
                               stdout=subprocess.PIPE)
        return ended.stdout

    def voxelize(self, mesh, points):
        volume = self.work / f"{mesh.stem}-{points}.bccb"
        self.run("voxelize", mesh, "--points", points, "-o", volume)
        return volume

    def generate(self, shape):
        volume = self.work / f"{shape}.bccb"
        self.run("generate", shape, "--points", TABLE_POINTS, "-o", volume)
        return volume

    def bench(self, volume, method, threads, repeat):
        return json.loads(self.run("bench", "core", "--object", volume, "--method", method,
                                   "--threads", threads, "--repeat", repeat, "--json"))

    def skeletonize(self, volume):
        """The file of the result and the summary."""
        result = volume.with_suffix(".json")
        summary = self.run("skeletonize", volume, "--local", "-o", result, "--json")
        return result, json.loads(summary)


def say(text):
    print(f"paper_figures: {text}", file=sys.stderr, flush=True)


def measure_growth(commands, meshes, sizes, repeat):
    """Core milliseconds by (name, method, threads): a list of (points, median)."""
    rows = collections.defaultdict(list)
    for name in GROWING:
        for points in sizes:
            say(f"growth, {name}, {points:,} points")
            volume = commands.voxelize(meshes / f"{name}.off", points)
            for method in METHODS:
                for threads in (1, 2):
                    run = commands.bench(volume, method, threads, repeat)
                    rows[name, method, threads].append((run["points"], milliseconds(run)))
    return rows


def milliseconds(run, key="ns_per_point", which="median"):
    return run[key][which] * run["points"] / 1e6


def measure_models(commands, meshes, output, repeat):
    models = []
    for name in MESHES + SHAPES:
        say(f"model, {name}")
        if name in MESHES:
            volume = commands.voxelize(meshes / f"{name}.off", TABLE_POINTS)
        else:
            volume = commands.generate(name)
        result, summary = commands.skeletonize(volume)
        commands.run("render", result, "--object", volume, "--size", PICTURE_SIZE,
                     "-o", output / f"{name}.png")
        runs = {(method, threads): commands.bench(volume, method, threads, repeat)
                for method in METHODS for threads in (1, 2)}
        models.append(Model(name, summary, runs))
    return models


def plot_growth(rows, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    colors = dict(zip(GROWING, ("tab:blue", "tab:orange", "tab:green")))
    styles = {("directional", 1): "-", ("directional", 2): ":", ("symmetric", 1): "--"}
    for (name, method, threads), points in rows.items():
        if (method, threads) not in styles:
            continue
        label = f"{name}, {method}, {threads} thread{'s' if threads > 1 else ''}"
        axes.loglog(*zip(*points), styles[method, threads], marker="o", markersize=3, label=label,
                    color=colors[name])
    for threads, marker in ((1, "v"), (2, "^")):
        axes.loglog([TABLE_POINTS], [PAPER_MS[threads]], marker, color="black", linestyle="none",
                    label=f"the paper, 2006, {threads} thread{'s' if threads > 1 else ''}")
    axes.set(xlabel="object points", ylabel="milliseconds",
             title="Distances, shells, thinning and clean-up")
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize="x-small")
    figure.tight_layout()
    figure.savefig(path, dpi=128)


def model_row(model):
    summary, runs = model.summary, model.runs
    betti = summary["certificate"]["skeleton"]
    cells = [f"![{model.name}]({model.name}.png)", model.name,
             f"{summary['object_points']:,}", f"{summary['skeleton_points']:,}",
             f"{betti['components']}, {betti['loops']}, {betti['cavities']}"]
    for method in METHODS:
        cells += [f"{milliseconds(runs[method, 1]):.1f}", f"{milliseconds(runs[method, 2]):.1f}",
                  f"{milliseconds(runs[method, 1], 'whole_ns_per_point'):.1f}"]
    return "| " + " | ".join(cells) + " |"


def model_table(models):
    lines = ["| picture | model | points | of the skeleton | components, loops, cavities | "
             "directional, ms: core, one thread | two | whole, one | "
             "symmetric, ms: core, one thread | two | whole, one |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    return lines + [model_row(model) for model in models]


def beside_the_paper(models):
    lines = ["| about 850,000 points | the paper, 2006 | here, median of the models | ratio |",
             "|---|---|---|---|"]
    words = {1: "one thread", 2: "two threads"}
    for threads, then in PAPER_MS.items():
        now = statistics.median(milliseconds(model.runs["directional", threads])
                                for model in models)
        bound = "less than" if threads == 1 else "about"
        lines.append(f"| {words[threads]} | {bound} {then} ms | {now:.1f} ms | {then / now:.0f} |")
    return lines


def document(programs, models, loads, seconds):
    compiler = report.output_of(programs.cached("CMAKE_CXX_COMPILER"), "--version")
    return "\n".join([
        "# Figures 11 and 12 of the paper, again", "",
        "Made by one command, which fetches the meshes out of the Debian package `libcgal-demo`:",
        "", "```sh", "tests/bench/paper_figures.py build/release", "```", "",
        "Brunner, Brunnett and Strand (2006) show the time of three models over their resolution",
        "(Fig. 11) and a table of models with points, time and picture (Fig. 12; a Pentium 4 with",
        "3 GHz). Their models are not ours, so what compares is what their text states of objects",
        "of this size:", "", *beside_the_paper(models), "",
        "## Time over growing resolution", "", "![time over points](growth.png)", "",
        "## Models", "",
        "Core is distances, shells, thinning and clean-up; whole adds pruning, certificate and",
        "graph. Directional is the paper's method with the paper's distances; symmetric is our",
        "default, with Euclidean distances. The skeleton in the picture and its points are the",
        "default's. Warm runs, medians.", "", *model_table(models), "",
        f"- {report.processor()}, {os.cpu_count()} processors, load {loads[0]:.2f} before and "
        f"{loads[1]:.2f} after (this program counts)",
        f"- {compiler.decode().splitlines()[0]}; revision {report.revision()}; "
        f"{time.strftime('%Y-%m-%d', time.gmtime())}, {seconds / 60:.0f} minutes", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", help="folder of a release build")
    parser.add_argument("--quick", action="store_true", help="few repetitions and sizes")
    parser.add_argument("--output", type=pathlib.Path, default=HERE / "paper")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    repeat = 3 if arguments.quick else 15
    sizes = GROWTH_POINTS[:3] if arguments.quick else GROWTH_POINTS
    start, load = time.monotonic(), os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as work:
        commands, meshes = Commands(arguments.build, work), pathlib.Path(work) / "meshes"
        subprocess.run([FETCH, meshes, *(f"{name}.off" for name in MESHES)], check=True,
                       stdout=subprocess.DEVNULL)
        plot_growth(measure_growth(commands, meshes, sizes, repeat),
                    arguments.output / "growth.png")
        models = measure_models(commands, meshes, arguments.output, repeat)
    text = document(report.Programs(arguments.build), models, (load, os.getloadavg()[0]),
                    time.monotonic() - start)
    (arguments.output / "README.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
