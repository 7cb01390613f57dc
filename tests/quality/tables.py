"""The tables and the plot of the report."""

NOISES = (0, 0.01, 0.02, 0.05, 0.1)
# Each along the axes on purpose: apart from the means.
APART = ("bar in a row", "bar between rows", "cube")
DEFAULT = "symmetric, Euclidean"
DENOISED = "default, plain flips denoised"


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else float("nan")


def percent(noise):
    return "clean" if noise == 0 else f"{100 * noise:g} %"


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows), ""]


def methods_of(rows):
    return list(dict.fromkeys(row["method"] for row in rows))


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def lined(rows):
    """Those with an offset: a known center line, and points."""
    return [row for row in rows if row["known_line"] and "raw" in row]


def summary(rows, method, noise):
    """A line of the large table: means over figures and rotations."""
    chosen = [r for r in select(rows, method=method, noise=noise) if r["figure"] not in APART]
    with_line, found = lined(chosen), [r for r in chosen if r["found"]]
    exact = sum(1 for r in chosen if r["lost"] == 0 and r["spurious"] == 0)
    cells = [method, percent(noise)]
    for kind in ("raw", "smooth"):
        cells += [f"{mean(r[kind]['mean'] for r in with_line):.2f}",
                  f"{max(r[kind]['mean'] for r in with_line):.2f}",
                  f"{mean(r[kind]['bias'] for r in with_line):.2f}"]
    cells += [f"{exact} of {len(chosen)}", sum(r["lost"] for r in chosen),
              sum(r["spurious"] for r in chosen), f"{mean(r['mean_gap'] for r in found):.2f}",
              f"{max(r['largest_gap'] for r in found):.1f}",
              f"{mean(abs(r['junctions'] - r['forks']) for r in with_line):.2f}"]
    return cells + along(with_line)


def along(rows):
    """The largest offset, and what only our results have: radii and lengths."""
    cells = [f"{worst(rows, 'smooth', 'largest'):.1f}"]
    if not all("radius_error" in row for row in rows):
        return cells + ["-", "-"]
    return cells + [f"{mean(r['radius_error'] for r in rows):.2f}",
                    f"{100 * mean(abs(r['length_error']) for r in rows):.1f} %"]


SUMMARY_HEAD = ["method, distance", "noise", "raw offset, mean", "worst figure", "bias",
                "smoothed offset, mean", "worst figure", "bias", "all ends right", "tips lost",
                "spurious ends", "gap to tips, mean", "largest", "branch points off by",
                "largest smoothed offset", "radius off by", "length off by"]


def offsets_section(figures, others):
    lines = ["## Against known center lines", "",
             "Means over figures and rotations. An end matches a tip if it lies within two radii "
             "plus 8 units of it. Noise flips that share of the points on both sides of the "
             "boundary, each only if that keeps the topology. Plain flips drop this condition, so "
             "they open tunnels and enclose cavities; `--denoise 1 --fill-cavities "
             "--keep-largest` repairs them, but not for the peer. Off by: mean absolute error.",
             ""]
    rows = [summary(figures, method, noise) for method in methods_of(figures) for noise in NOISES
            if select(figures, method=method, noise=noise)]
    rows += [summary(others, method, noise) for method in methods_of(others)
             for noise in NOISES if select(others, method=method, noise=noise)]
    return lines + table(SUMMARY_HEAD, rows)


def worst(rows, key, part=None):
    return max((row[key][part] if part else row[key]) for row in rows)


def figure_rows(figures, figure):
    """The default method, clean and with 5 % noise."""
    for noise in (0, 0.05):
        rows = select(figures, figure=figure, method=DEFAULT, noise=noise)
        first, with_line = rows[0], lined(rows)
        known = first["known_line"]
        yield [figure, percent(noise), first["tips"], f"{mean(r['ends'] for r in rows):g}",
               f"{mean(r['raw']['mean'] for r in with_line):.2f}" if known else "-",
               f"{mean(r['smooth']['mean'] for r in with_line):.2f}" if known else "-",
               f"{worst(with_line, 'smooth', 'largest'):.1f}" if known else "-",
               f"{mean(r['radius_bias'] for r in rows):+.2f}" if known else "-",
               f"{100 * mean(r['length_error'] for r in rows):+.1f} %" if known else "-",
               f"{mean(r['mean_gap'] for r in rows):.1f}", f"{worst(rows, 'largest_gap'):.1f}",
               f"{first['forks']} / {mean(r['junctions'] for r in rows):.3g}" if known else "-",
               f"{first['loops']} / {first['loops_found']}"]


def figures_section(figures):
    names = list(dict.fromkeys(row["figure"] for row in figures))
    lines = ["## Figure by figure, default settings", "",
             "The first five resemble the shapes on which the defaults were tuned. Radius: the "
             "result's minus the true one; noise makes balls smaller, since they stop at the "
             "first pit. A horse's limbs are spheroids that end in points: there the gap is the "
             "length cut from the last, thin part. A cube has no true tips; its middle is kept.", ""]
    head = ["figure", "noise", "tips", "ends", "raw", "smoothed", "largest", "radius", "length",
            "gap, mean", "largest", "branch points, true / found", "loops, true / found"]
    return lines + table(head, [row for name in names for row in figure_rows(figures, name)])


def rotations_section(rotations):
    lines = ["## Turning the grid and the figure", "",
             "Grid: the 24 rotations of the grid turn the points of one object. Free: the figure "
             "is turned before it is sampled. Mean: the distance from a point to the other "
             "skeleton, in both directions; Hausdorff: the largest such distance in a run.", ""]
    rows = []
    for method in methods_of(rotations):
        for change in ("grid", "free"):
            chosen = select(rotations, method=method, change=change)
            rows.append([method, change, f"{mean(r['mean'] for r in chosen):.3f}",
                         f"{mean(r['smooth_mean'] for r in chosen):.3f}",
                         f"{mean(r['largest'] for r in chosen):.2f}",
                         f"{worst(chosen, 'largest'):.1f}",
                         f"{sum(1 for r in chosen if r['ends'] != 0)} of {len(chosen)}"])
    return lines + table(["method, distance", "rotation", "mean, points", "mean, smoothed",
                          "Hausdorff, mean", "worst", "number of ends changed"], rows)


def thinness_section(figures):
    rows = []
    for method in methods_of(figures):
        chosen = select(figures, method=method)
        rows.append([method, sum(r["simple_left"] for r in chosen),
                     f"{100 * mean(r['clustered'] for r in chosen):.1f} %",
                     f"{100 * worst(chosen, 'clustered'):.1f} %"])
    return ["## Thinness", "",
            "Over all figures, rotations and noise. Clusters are points with three or more "
            "neighbors, or with two that are neighbors of each other: junctions and thick bends.", "",
            *table(["method, distance", "simple points left but ends", "points in clusters, mean",
                    "worst"], rows)]


def reconstruction_section(reconstruction):
    names = list(dict.fromkeys(row["figure"] for row in reconstruction))
    kinds = list(dict.fromkeys(row["kind"] for row in reconstruction))
    rows = [[name, *(f"{select(reconstruction, figure=name, kind=kind)[0]['jaccard']:.3f}"
                     for kind in kinds)] for name in names]
    return ["## Reconstruction", "",
            "Jaccard index of the object and the union of the largest balls around the skeleton's "
            "points.", "", *table(["figure", *kinds], rows)]


def meshes_section(meshes):
    clean = [r for r in meshes if r["study"] == "meshes"]
    if not clean:
        return []
    rows = []
    for name in dict.fromkeys(r["figure"] for r in clean):
        for method in methods_of(clean):
            chosen = {r["noise"]: r for r in select(clean, figure=name, method=method)}
            moved = {r["change"]: r for r in meshes
                     if r["study"] == "mesh noise" and r["figure"] == name
                     and r["method"] == method}
            first = chosen[0]
            rows.append([name, method, first["components"], first["loops"],
                         *(chosen[n]["ends"] for n in (0, 0.02, 0.05)),
                         *(f"{moved[n]['smooth_mean']:.2f}" for n in ("0.02", "0.05")),
                         sum(r["simple_left"] for r in chosen.values())])
    return ["## Meshes", "",
            "Only the components and loops of meshes are known; the number of ends should not "
            "change with noise. Moved: the mean distance between the smoothed curves of the clean "
            "and the noisy object.", "",
            *table(["mesh", "method, distance", "components", "loops", "ends, clean", "2 %", "5 %",
                    "moved, 2 %", "5 %", "simple points left"], rows)]


def target(what, wanted, value, met):
    return [what, wanted, value, "yes" if met else "**no**"]


def target_rows(figures, others, rotations):
    chosen = [r for r in select(figures, method=DEFAULT) if r["figure"] not in APART]
    clean, noisy = select(chosen, noise=0), [r for r in chosen if r["noise"] > 0]
    for name, rows in (("clean", clean), ("noise of 1, 2, 5, 10 %", noisy)):
        exact = sum(1 for r in rows if r["lost"] == 0 and r["spurious"] == 0)
        yield target(f"ends are the true tips, {name}", "all runs", f"{exact} of {len(rows)}",
                     exact == len(rows))
    flips = [r for r in select(figures, method=DENOISED) if r["figure"] not in APART]
    exact = sum(1 for r in flips if r["lost"] == 0 and r["spurious"] == 0)
    yield target("the same for plain flips of 2, 5, 10 %, denoised", "all runs",
                 f"{exact} of {len(flips)}", exact == len(flips))
    for name, rows, raw, smoothed in (("clean", clean, 0.75, 0.18), ("noise", noisy, 0.8, 0.31)):
        for kind, limit in (("raw", raw), ("smooth", smoothed)):
            value = mean(r[kind]["mean"] for r in lined(rows))
            largest = worst(lined(rows), kind, "mean")
            yield target(f"mean offset, {kind}, {name}", f"<= {limit}",
                         f"{value:.2f} (worst object {largest:.2f})", value <= limit)
    bias = mean(r["raw"]["bias"] for r in lined(chosen))
    yield target("bias", "<= 0.15", f"{bias:.2f}", bias <= 0.15)
    with_tips = [r for r in chosen if r["found"]]
    gap, largest = mean(r["mean_gap"] for r in with_tips), worst(with_tips, "largest_gap")
    yield target("gap to the true tips, mean", "<= 1.1", f"{gap:.2f}", gap <= 1.1)
    over = sum(1 for r in with_tips if r["largest_gap"] > 4)
    yield target("gap to the true tips, largest", "<= 4",
                 f"{largest:.1f}; over 4 in {over} of {len(with_tips)} objects", largest <= 4)
    grid = select(rotations, method=DEFAULT, change="grid")
    moved = mean(r["mean"] for r in grid)
    yield target("24 rotations, mean way between points", "<= 0.1", f"{moved:.3f}", moved <= 0.1)
    changed = sum(1 for r in grid if r["ends"] != 0)
    yield target("24 rotations, number of ends", "unchanged", f"changed in {changed} of "
                 f"{len(grid)}", changed == 0)
    bar = select(figures, figure="bar in a row", method=DEFAULT, noise=0)[0]
    yield target("4 x 4 x 100 bar", "one curve along its length",
                 f"{bar['ends']} ends, {bar['lost']} lost", bar["ends"] == 2 and not bar["lost"])
    if others:
        yield peer_target(clean, others)


def peer_target(clean, others):
    theirs = [r for r in select(others, noise=0) if r["figure"] not in APART]
    ours, other = (mean(r["smooth"]["mean"] for r in lined(rows)) for rows in (clean, theirs))
    return target("smoothed offset against the peer's, clean", "smaller",
                  f"{ours:.2f} against {other:.2f}", ours < other)


def report(figures, others, rotations, reconstruction, meshes, wild_tables=()):
    rows = list(target_rows(figures, others, rotations))
    return ["## Targets", "", f"Default settings ({DEFAULT}). Bars along the axes and the cube are "
            "not in the means.", "", *table(["what", "target", "measured", "met"], rows),
            *offsets_section(figures, others), *figures_section(figures),
            *rotations_section(rotations), *thinness_section(figures),
            *reconstruction_section(reconstruction), *meshes_section(meshes),
            *wild_tables]


def plot(figures, others, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    drawing, axes = pyplot.subplots(figsize=(8, 4.5))
    for method in methods_of(figures):
        rows = [r for r in lined(select(figures, method=method)) if r["figure"] not in APART]
        if not select(rows, noise=0):
            continue
        axes.plot([100 * n for n in NOISES],
                  [mean(r["smooth"]["mean"] for r in rows if r["noise"] == n) for n in NOISES],
                  marker="o", markersize=3, label=method)
    if others:
        # Noisy objects get plain flips there, which is another thing.
        rows = [r for r in lined(select(others, noise=0)) if r["figure"] not in APART]
        axes.plot([0], [mean(r["smooth"]["mean"] for r in rows)], "ks", markersize=5,
                  label="scikit-image, clean")
    axes.set(xlabel="boundary points flipped, percent", ylabel="mean offset, lattice units",
             title="Smoothed curves against known center lines", ylim=(0, None))
    axes.grid(True, linewidth=0.3)
    axes.legend(fontsize="small")
    drawing.tight_layout()
    drawing.savefig(path, dpi=128)
