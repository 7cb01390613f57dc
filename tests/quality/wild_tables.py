"""The tables of figures in the wild, and of real masks and meshes."""

from tables import mean, percent, select, table, target, worst

SPINY = ("spines", "brush", "soma")
FLAT = ("flat limbs", "flat alone")
LIMBS = ("palm", *FLAT, "cone", "flat cut", "blunt")


def groups(wild):
    """The objects of a grid and a size: what they are called, the rows, the unit of lengths."""
    for kind in dict.fromkeys(r["as"] for r in wild):
        for points in dict.fromkeys(r["points"] for r in wild):
            rows = select(wild, points=points, **{"as": kind})
            if rows:
                yield ((f"masks of {points:,} voxels", rows, "voxels") if kind == "mask"
                       else (f"objects of {points:,} points", rows, "units"))


def of_classes(rows, classes):
    return [r for r in rows if r["class"] in classes]


def spiny_targets(name, rows, unit):
    spiny = of_classes(rows, SPINY)
    wrong = [(r["lost"] + r["spurious"]) / r["tips"] for r in spiny]
    exact, most = wrong.count(0), max(wrong)
    yield target(f"spiny {name}: all ends right, all noises", "9 of 10, at most 1 in 20 ends wrong",
                 f"{exact} of {len(wrong)}, at most {100 * most:.0f} % wrong",
                 exact >= 0.9 * len(wrong) and most <= 0.05)
    limit = 5 if unit == "units" else 2
    gap = worst(spiny, "largest_gap")
    yield target(f"spiny {name}: farthest tip", f"<= {limit} {unit}", f"{gap:.1f}", gap <= limit)


def limb_targets(name, rows, unit):
    limbs = of_classes(rows, LIMBS)
    lost = sum(r["lost"] for r in limbs)
    yield target(f"palms, flat limbs, cones, cuts, {name}: lost", "0", f"{lost}", lost == 0)
    for noise, limit in ((0, 0.3), (0.05, 1)):
        chosen = select(limbs, noise=noise)
        if chosen:
            spurious = max(mean(r["spurious"] for r in select(chosen, **{"class": c}))
                           for c in dict.fromkeys(r["class"] for r in chosen))
            yield target(f"the same, {percent(noise)}: spurious ends an object, worst class",
                         f"<= {limit}", f"{spurious:.2f}", spurious <= limit)
    off = worst(of_classes(rows, FLAT), "line_mean")
    yield target(f"flat limbs, {name}: off their line, worst object", f"<= 1 {unit}",
                 f"{off:.2f}", off <= 1)


def network_target(name, rows, _):
    networks = of_classes(rows, ("network",))
    found, true = (sum(r[key] for r in networks) for key in ("junctions", "true_junctions"))
    yield target(f"networks, {name}: junctions", "within 5 %", f"{found} of {true}",
                 abs(found - true) <= 0.05 * true)


def cost_target(name, rows, _):
    if rows[0]["points"] >= 850_000 and rows[0]["as"] == "bcc":
        chosen = select(rows, noise=0)
        share = sum(r["pruning_ms"] for r in chosen) / sum(r["total_ms"] for r in chosen)
        yield target(f"pruning and tips, share of a run, {name}", "<= 20 %",
                     f"{100 * share:.0f} %", share <= 0.2)


def apart(counts):
    return max(counts) - min(counts)


def span(counts):
    return f"{min(counts)} to {max(counts)}"


def mesh_targets(meshes):
    for what, key, most in (("at several sizes", "ends", 2), ("in several poses", "pose_ends", 1),
                            ("in several poses, lattice along the world's axes",
                             "world_pose_ends", 1)):
        ways = [apart(r[key]) for r in meshes]
        yield target(f"ends of a mesh {what}", f"equal in 8 of 10, never more than {most} apart",
                     f"equal in {ways.count(0)} of {len(ways)}, up to {max(ways)} apart",
                     ways.count(0) >= 0.8 * len(ways) and max(ways) <= most)
    for key, what in (("p95", ""), ("world_p95", ", lattice along the world's axes")):
        far = [r[key] for r in meshes]
        yield target(f"distance between poses over the radius, 95th percentile{what}", "<= 0.5",
                     f"in {sum(x <= 0.5 for x in far)} of {len(far)} meshes; worst {max(far):.2f}",
                     max(far) <= 0.5)


def mask_targets(masks):
    for kinds, limit in ((("neuron",), 1), (("vessels", "airway"), 2)):
        share = 100 * max((r["redundant_length"] for r in masks if r["kind"] in kinds), default=0)
        yield target(f"redundant length, {' and '.join(kinds)}, worst", f"<= {limit} %",
                     f"{share:.1f} %", share <= limit)
    twigs = sum(r["twigs"] for r in masks)
    yield target("twigs on real masks", "0", f"{twigs}", twigs == 0)
    missed = max((r["missed"] for r in masks if r["kind"] == "airway"), default=0)
    yield target("missed parts of the airway", "<= 5", f"{missed}", missed <= 5)


def open_target(lengths):
    chosen = [r for r in lengths if 8 <= r["length"] <= 24]
    ends = ", ".join(str(r["ends"]) for r in chosen)
    yield target("mask of a ball of radius 20 with six spines of radius 2 and "
                 + ", ".join(f"{r['length']:g}" for r in chosen) + " voxels: ends", "6 each", ends,
                 all(r["ends"] == 6 for r in chosen))


def target_rows(wild, lengths, meshes, masks):
    for name, rows, unit in groups(wild):
        for rule in (spiny_targets, limb_targets, network_target, cost_target):
            yield from rule(name, rows, unit)
    yield from open_target(lengths)
    if meshes:
        yield from mesh_targets(meshes)
    if masks:
        yield from mask_targets(masks)


def class_rows(chosen, noises):
    for name in dict.fromkeys(r["class"] for r in chosen):
        rows = select(chosen, **{"class": name})
        known, ends = rows[0]["known"], []
        for noise in noises:
            noisy = select(rows, noise=noise)
            ends.append(f"{sum(r['lost'] for r in noisy)} / {sum(r['spurious'] for r in noisy)}"
                        if known else f"{mean(r['ends'] for r in noisy):.3g} ends")
        exact = sum(1 for r in rows if not r["lost"] and not r["spurious"])
        off, true = worst(rows, "line_mean"), sum(r["true_junctions"] for r in rows)
        pruning, total = (sum(r[key] for r in rows) for key in ("pruning_ms", "total_ms"))
        yield [name, len(rows), sum(r["tips"] for r in rows) if known else "-", *ends,
               exact if known else "-", f"{worst(rows, 'largest_gap'):.1f}" if known else "-",
               f"{off:.2f}" if off else "-",
               f"{sum(r['junctions'] for r in rows)} / {true}" if true > 0 else "-",
               f"{100 * pruning / total:.0f} %"]


def figures_section(wild):
    lines = ["## Figures in the wild", "",
             "Objects like those that people have: spines, flat parts, networks, cuts, rough "
             "surfaces. Each is turned at random and studied as a bcc object and as a mask of as "
             "many voxels. This is the half of seeds and figures on which no rule was chosen. "
             "Columns by noise, which keeps the topology of points or voxels: true tips without "
             "an end / ends without a true tip. An end may lie up to half a limb from its tip; "
             "the gap is this distance, in lattice units or voxel edges. Plates, disks and "
             "castings have no true tips.", ""]
    noises = sorted({r["noise"] for r in wild})
    head = ["class", "objects", "tips", *map(percent, noises), "all ends right", "largest gap",
            "off the middle, worst", "junctions found / true", "pruning's share"]
    for name, rows, _ in groups(wild):
        lines += [f"### {name.capitalize()}", "", *table(head, list(class_rows(rows, noises)))]
    return lines


def meshes_section(meshes):
    if not meshes:
        return []
    points = meshes[0]["points"]
    rows = [[r["mesh"], *r["ends"], apart(r["ends"]),
             span(r["pose_ends"]), f"{r['p95']:.2f}", span(r["world_pose_ends"]),
             f"{r['world_p95']:.2f}", f"{r['world_smooth_p95']:.2f}", f"{r['world_largest']:.1f}"]
            for r in meshes]
    return ["## Meshes at several sizes and in several poses", "",
            f"Ends by number of points, and at {points[0]:,} points in "
            f"{len(meshes[0]['pose_ends'])} random rotations. Distance: from the points of a "
            "skeleton to the one in the first pose, and back, relative to the radius there, in "
            "the worst pose; smooth: between the smooth curves. World: the same with the lattice "
            "along the world's axes (`--lattice-axes world`), as in images.", "",
            *table(["mesh", *(f"{n:,}" for n in points), "apart", "ends in poses",
                    "distance, 95th percentile", "world: ends in poses",
                    "distance, 95th percentile", "smooth", "largest"], rows)]


def masks_section(masks, others):
    if not masks:
        return []
    rows = []
    for r in masks:
        other = next((o for o in others if o["mask"] == r["mask"]), None)
        rows.append([r["mask"], r["kind"], f"{r['voxels']:,}", r["loops"], r["ends"], r["branches"],
                     r["twigs"], f"{100 * r['redundant_length']:.2f} %", r["missed"],
                     f"{r['seconds']:.1f}", *([other["ends"], other["missed"],
                                               f"{other['seconds']:.1f}"] if other else "---")])
    return ["## Real masks", "",
            "Default settings. Twigs are end branches whose part outside the ball of their "
            "junction is shorter than their radius there. Redundant length is the share inside "
            "0.9 of the largest ball of a point of another edge more than two of its radii away "
            "along the graph (strands, ribs, doubled curves), except for edges that no removal of "
            "ends can affect. Missed parts are connected groups of more than 20 voxels that lie "
            "more than 4 voxels outside all balls. The time excludes conversion.", "",
            *table(["mask", "kind", "voxels", "loops", "free ends", "branches", "twigs",
                    "redundant length", "missed parts", "seconds", "peer's free ends",
                    "missed parts", "seconds"], rows)]


# Of bccskel_quality, and the kinds of masks that they are for.
MASK_OPTIONS = {"--border ends": ("neuron", "vessels", "airway", "scan"),
                "--border continues": ("neuron", "vessels", "airway", "scan"),
                "--preset neuron": ("neuron",), "--preset vessels": ("vessels",),
                "--preset airway": ("airway",), "--preset materials": ("scan",)}


def options_section(masks, changed):
    if not masks:
        return []
    figures = ("components", "loops", "ends", "branches", "twigs", "missed")
    rows = []
    for words, kinds in MASK_OPTIONS.items():
        for before in (r for r in masks if r["kind"] in kinds):
            after = next(r for r in changed[words] if r["mask"] == before["mask"])
            share = [f"{100 * r['redundant_length']:.2f}" for r in (before, after)]
            rows.append([words, before["mask"],
                         *(f"{before[key]} -> {after[key]}" for key in figures),
                         f"{share[0]} -> {share[1]} %"])
    return ["## Options for real masks", "",
            "Values with the defaults and with the option. A preset may change the topology: it "
            "fills cavities and narrow tunnels and removes small components, so there are fewer "
            "loops and components. `--border` keeps the topology. `continues` is not the default, "
            "which looks for the faces of the image that cut limbs off: an object that lies flat "
            "along a face would get a curve in that face beside its others, which is redundant "
            "length.",
            "",
            *table(["option", "mask", "components", "loops", "free ends", "branches", "twigs",
                    "missed parts", "redundant length"], rows)]


def slices_section(slices):
    rows = [[f"{r['thickness']:g}", f"{r['half_width']:g}", r["tubes"], r["wrong"], f"{r['gap']:.2f}",
             f"{r['largest_gap']:.2f}", r["narrow"], f"{r['off']:.2f}"] for r in slices]
    return ["## Thick slices", "",
            "Masks of tubes with round caps in random directions, in slices 1 to 8 times as thick "
            "as voxels are wide. Gap: from an end to the center of its cap, in slices. Narrow "
            "ends have less than half the tube's radius. Off the middle: the farthest point of a "
            "curve, in radii, mean over tubes.", "",
            *table(["thickness", "half-width in slices", "tubes", "without two ends", "gap",
                    "largest gap", "narrow ends", "off the middle"], rows)]


def cuts_section(cuts):
    rows = [[f"{r['width']:g}:1", f"{r['radius']:g}", r["degrees"], r["limbs"], r["wrong"],
             f"{r['gap']:.2f}", f"{r['largest_gap']:.2f}", f"{r['end_radius']:.2f}"] for r in cuts]
    return ["## Limbs that the border cuts", "",
            "Masks of straight limbs with elliptic sections that the border of the image cuts off "
            "at both ends, at angles of about so many degrees between the limb and the normal. "
            "Gap: from the middle of the cut to the nearest end, median and largest; with the "
            "radius of that end in the median. All lengths in radii of the limb, the radius "
            "itself in voxels.", "",
            *table(["section", "radius", "degrees", "limbs", "without two ends", "gap",
                    "largest gap", "radius of the end"], rows)]


def faces_section(faces):
    crowded = [row for row in faces if row["what"] == "crossing limbs"]
    kinds = sorted({(row["width"], row["radius"]) for row in crowded})
    borders = list(dict.fromkeys(row["border"] for row in crowded))

    def cells(width, radius, border):
        row = next(r for r in crowded if (r["width"], r["radius"], r["border"]) == (width, radius, border))
        return f"{row['found']} of {row['cuts']}", f"{row['elsewhere']} of {row['at_border']}"

    rows = [[f"{width:g}:1", f"{radius:g}", *(cell for border in borders
                                             for cell in cells(width, radius, border))]
            for width, radius in kinds]
    heads = [head for border in borders for head in (f"{border}: cuts with an end", "other ends")]
    tight = ", ".join(f"{row['border']} {row['changed']}" for row in faces
                      if row["what"] == "tight crops")
    figures = max(row["figures"] for row in faces if row["what"] == "tight crops")
    return ["## Images that cut many limbs", "",
            "Masks of cubes 10 radii wide that seven straight limbs cross, by `--border`; many "
            "cross others just before the border. Cuts: those at up to 50 degrees, away from the "
            "edges of the image, whose middle no other limb comes near; they have an end if it lies within their "
            "half-width. Other ends: those at the border that belong to no cut of a limb, however "
            "slanted. Radii in voxels.", "",
            *table(["section", "radius", *heads], rows), "",
            "An image that was cropped to its object cuts nothing off. Figures of the classes "
            f"above that have another number of ends in the box of their voxels, of {figures}: "
            f"{tight}."]


def report(wild, lengths, slices, cuts, faces, meshes, masks, others, changed):
    return ["## Targets in the wild", "",
            *table(["what", "target", "measured", "met"],
                   list(target_rows(wild, lengths, meshes, masks))),
            *figures_section(wild), *slices_section(slices), *cuts_section(cuts),
            *faces_section(faces), *meshes_section(meshes), *masks_section(masks, others), *options_section(masks, changed)]
