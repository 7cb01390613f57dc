"""Images of labels: one skeleton for each, in files of their own or in one with all."""

import csv
import json
import os
import pathlib
import re
import xml.etree.ElementTree

import harness
import networkx
import numpy

HUGE = 2**64 - 1


def touching_labels():
    """Two bars side by side, a ring around a third, and a speck; index (z, y, x)."""
    labels = numpy.zeros((9, 20, 30), "<u8")
    labels[3:6, 2:5, 2:28] = 3
    labels[3:6, 5:8, 2:28] = HUGE
    labels[3:6, 10:18, 10:20] = 12
    labels[3:6, 13:15, 13:17] = 8
    labels[0, 0, 0] = 1
    return labels


class LabelsTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.image = self.path("labels.npy")
        numpy.save(self.image, touching_labels())

    def succeed_with_notes(self, *words):
        """The output of a command that may warn of what preparing did to labels."""
        done = harness.bccskel("labels", self.image, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        for line in done.stderr.splitlines():
            self.assertRegex(line, f"^bccskel: warning: {self.image}: label [0-9]+: "
                             "(nothing is left of the object after|preparing changed)")
        return done.stdout

    def labels(self, *words):
        return json.loads(self.succeed_with_notes("--json", *words))

    def test_every_label_has_a_skeleton_with_its_own_check(self):
        summary = self.labels("-o", self.path("all.json"))
        loops = {label["label"]: label["certificate"]["skeleton"]["loops"]
                 for label in summary["labels"]}
        self.assertEqual(loops, {1: 0, 3: 0, 8: 0, 12: 1, HUGE: 0})
        for label in summary["labels"]:
            certificate = label["certificate"]
            self.assertTrue(label["topology_kept"])
            self.assertEqual(certificate["mask"], certificate["input"])
            self.assertEqual(certificate["mask"]["components"], 1)
            self.assertEqual(certificate["simple_points_left"], 0)
            self.assertEqual(label["voxels"],
                             int((touching_labels() == label["label"]).sum()))

    def test_a_label_is_skeletonized_as_if_it_were_alone(self):
        summary = self.labels("-o", self.path("all.json"))
        for label in summary["labels"]:
            alone = json.loads(self.succeed(
                "skeletonize", self.image, "--label", str(label["label"]), "--local", "--json",
                "-o", self.path("alone.json")))
            self.assertEqual(alone["sha256"], label["sha256"])

    def test_a_picture_shows_all_labels_each_in_its_color(self):
        self.labels(*harness.outputs(self.path(name) for name in ("a.svg", "a.png", "a.html")))
        svg = (self.folder / "a.svg").read_text(encoding="utf-8")
        self.assertIn(">labels.npy</text>", svg)
        self.assertIn(">5 labels: ", svg)
        self.assertIn(", 5 components, 1 loop, 0 cavities  ", svg)
        self.assertIn(">each label in its own color</text>", svg)
        lines = re.findall(r'<path stroke="(#[0-9a-f]{6})" d="M', svg)
        self.assertEqual(len(set(lines)), 3)  # labels 1 and 8 are points
        self.labels("-o", self.path("b.svg"), "--min-component", "30")  # leaves nothing of label 1
        svg = (self.folder / "b.svg").read_text(encoding="utf-8")
        self.assertIn(">5 labels: ", svg)
        self.assertEqual(set(re.findall(r'<path stroke="(#[0-9a-f]{6})" d="M', svg)), set(lines))
        first = (self.folder / "a.html").read_bytes()
        self.labels("-o", self.path("a.html"), "--threads", "3")
        self.assertEqual((self.folder / "a.html").read_bytes(), first)

    def test_a_picture_of_each_label_shows_its_object(self):
        self.labels("--label", "3,12", "-o", self.path("{label}.svg"), "-o", self.path("{label}.png"))
        for label in (3, 12):
            self.assertGreater(os.path.getsize(self.path(f"{label}.png")), 5000)
            svg = (self.folder / f"{label}.svg").read_text(encoding="utf-8")
            self.assertIn(f">labels.npy, label {label}</text>", svg)
            self.succeed("skeletonize", self.image, "--label", str(label), "-o", self.path("alone.svg"))
            images = [re.findall('base64,([^"]*)', (self.folder / name).read_text(encoding="utf-8"))
                      for name in (f"{label}.svg", "alone.svg")]
            self.assertEqual(images[0], images[1])  # of the objects

    def test_a_server_makes_the_same_skeletons(self):
        chosen = ("--label", "3-12", "--min-voxels", "2", "--preset", "vessels",
                  "--adjacency", "6,26", "--voxel-points", "16")
        with harness.Server(self.folder) as server:
            for words in ((), chosen):
                here, there = ([self.path(f"{where}.{ending}") for ending in ("json", "csv", "glb")]
                               for where in ("here", "there"))
                local = self.labels(*words, *harness.outputs(here))
                remote = self.labels(*words, *harness.outputs(there), "--server", server.address)
                self.assertEqual(local["labels"], remote["labels"])
                self.assertEqual(local["left_out"], remote["left_out"])
                for mine, theirs in zip(here[1:], there[1:]):  # the JSON says how long it took
                    self.assertEqual(pathlib.Path(mine).read_bytes(),
                                     pathlib.Path(theirs).read_bytes())
            done = harness.bccskel("labels", self.image, "-o", self.path("a.csv"), "--server",
                                   server.address, "--progress", "always")
            self.assertIn("] label 5/5  ", done.stderr)
            for words, message in ((("--sampling", "nearest", "-o", self.path("a.csv")),
                                    "--sampling is for this machine"),
                                   (("-o", self.path("{label}.exr")), "no thinned volumes")):
                self.fail_with(2, message, "labels", self.image, "--server", server.address, *words)
        self.fail_with(4, "compute here with --local", "labels", self.image, "--server",
                       server.address, "-o", self.path("a.csv"))

    def test_a_list_and_a_smallest_size_choose(self):
        summary = self.labels("--label", "1,3,8", "--min-voxels", "2", "-o", self.path("a.vtp"))
        self.assertEqual([label["label"] for label in summary["labels"]], [3, 8])
        self.assertEqual(summary["left_out"], 1)

    def test_threads_do_not_matter(self):
        files = []
        for threads in ("1", "3"):
            self.labels("--threads", threads, "-o", self.path("all.graphml"))
            files.append((self.folder / "all.graphml").read_bytes())
        self.assertEqual(files[0], files[1])

    def test_a_place_for_the_label_makes_a_file_for_each(self):
        self.labels("-o", self.path("neuron-{label}.swc"), "-o", self.path("{label}.exr"))
        for label in (1, 3, 8, 12, HUGE):
            rows = numpy.loadtxt(self.folder / f"neuron-{label}.swc", ndmin=2)
            self.assertEqual((rows[:, 6] == -1).sum(), 1)
            self.assertTrue((self.folder / f"{label}.exr").exists())

    def test_folders_that_the_label_names_are_made(self):
        self.labels("-o", self.path("{label}/skeleton.swc"), "-o", self.path("of-{label}/a/b.json"))
        for label in (1, 3, 8, 12, HUGE):
            self.assertTrue((self.folder / f"{label}/skeleton.swc").exists())
            self.assertTrue((self.folder / f"of-{label}/a/b.json").exists())
        done = self.fail_with(8, self.path("missing/{label}"), "labels", self.image, "-o",
                              self.path("missing/{label}/a.swc"))
        self.assertNotIn("cannot make", done.stderr)  # said before the work
        self.assertFalse((self.folder / "missing").exists())
        (self.folder / "cell-3").touch()
        self.fail_with(8, "cannot create the folder " + self.path("cell-3"), "labels", self.image,
                       "--label", "3", "-o", self.path("cell-{label}/a.swc"))

    def test_gray_levels_are_no_labels(self):
        gray = numpy.random.default_rng(1).integers(0, 200, (8, 40, 40), "u1")
        numpy.save(self.path("gray.npy"), gray)
        warning = "gray.npy: the values look like gray levels, not labels, and each value is an " \
                  "object; bccskel skeletonize --threshold "
        done = harness.bccskel("labels", self.path("gray.npy"), "-o", self.path("a.csv"))
        self.assertIn(warning, done.stderr)
        for words in (("labels", self.path("gray.npy"), "--label", "7"), ("labels", self.image)):
            done = harness.bccskel(*words, "-o", self.path("a.csv"))
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_what_is_no_image_has_no_labels(self):
        mesh = self.write("a.off", "OFF\n0 0 0\n")
        self.fail_with(3, "a.off: is a mesh, which has no labels; bccskel skeletonize takes it",
                       "labels", mesh, "-o", self.path("a.csv"))
        self.fail_with(3, "is a volume, which has no labels; bccskel skeletonize takes it",
                       "labels", self.generate("ball"), "-o", self.path("a.csv"))
        result = self.path("all.json")
        self.labels("-o", result)
        done = self.fail_with(3, "all.json: is no mesh, volume or image; bccskel view shows a result",
                              "labels", result, "-o", self.path("a.csv"))
        self.assertEqual(done.stderr.count(result), 1)

    def test_the_summary_adds_up_what_preparing_did(self):
        labels = numpy.zeros((9, 9, 30), "u1")
        labels[1:8, 1:8, 1:8] = 1
        labels[1:8, 1:8, 10:18] = 2
        labels[4, 4, 4] = labels[4, 4, 12] = labels[4, 4, 14] = 0  # cavities
        numpy.save(self.image, labels)
        text = self.succeed_with_notes("--fill-cavities", "-o", self.path("all.json"))
        self.assertIn("given:     2 components, 0 loops, 3 cavities\n", text)
        self.assertRegex(text, r"prepared:  3 cavities filled \+[0-9]+\n")
        self.assertIn("topology of the prepared object kept, preparing changed cavities 3 -> 0, in 2 of "
                      "2 labels, ", text)

    def test_files_of_all_labels_say_which_is_which(self):
        names = [self.path(name) for name in ("all.vtp", "all.graphml", "all.json")]
        self.labels(*harness.outputs(names))
        everything = {1, 3, 8, 12, HUGE}
        root = xml.etree.ElementTree.parse(names[0])
        column = root.find(".//CellData/DataArray[@Name='label']").text.split()
        self.assertEqual({int(label) for label in column}, everything)
        graph = networkx.read_graphml(names[1])
        for part in networkx.connected_components(graph):
            self.assertEqual(len({graph.nodes[node]["label"] for node in part}), 1)
        self.assertEqual({int(label) for _, label in graph.nodes(data="label")}, everything)
        # A long of GraphML, 64 bits with a sign, would be too short.
        self.assertIn('attr.name="label" attr.type="string"', pathlib.Path(names[1]).read_text())
        document = self.read_json("all.json")
        self.assertEqual([entry["label"] for entry in document["labels"]], sorted(everything))
        for entry in document["labels"]:
            self.assertGreater(len(entry["skeleton"]["nodes"]), 0)

    def test_the_branch_table_names_the_label_of_each_branch(self):
        self.labels("-o", self.path("all.csv"), "-o", self.path("{label}.csv"))
        with open(self.path("all.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for label in {int(row["label"]) for row in rows}:
            with open(self.path(f"{label}.csv"), newline="", encoding="utf-8") as file:
                alone = list(csv.DictReader(file))
            lengths = [row["branch_distance"] for row in rows if int(row["label"]) == label]
            self.assertEqual(lengths, [row["branch_distance"] for row in alone])
        self.assertIn(HUGE, {int(row["label"]) for row in rows})

    def test_a_range_of_labels_is_taken(self):
        summary = self.labels("--label", "3-9", "-o", self.path("a.vtp"))
        self.assertEqual([label["label"] for label in summary["labels"]], [3, 8])

    def test_the_check_says_what_changed_labels_before_thinning(self):
        def check(*words):
            done = harness.bccskel("labels", self.image, "-o", self.path("a.csv"), *words)
            return re.search("^check: +(.*)", done.stdout, re.M).group(1), done.stderr
        self.assertEqual(check()[0], "topology kept, 0 simple points left")
        prepared, _ = check("--min-component", "10")
        self.assertEqual(prepared, "topology of the prepared object kept, preparing changed components "
                         "5 -> 4, in 1 of 5 labels, 0 simple points left")
        sampled, said = check("--sampling", "nearest", "--density", "0.2")
        self.assertRegex(sampled, "topology of the sampled object kept, sampling changed .*, in [1-5] "
                         "of 5 labels, 0 simple")
        self.assertIn("sampling changed the topology: ", said)

    def test_a_range_may_begin_at_the_background_which_is_left_out(self):
        summary = self.labels("--label", "0-9", "-o", self.path("a.vtp"))
        self.assertEqual([label["label"] for label in summary["labels"]], [1, 3, 8])

    def test_info_tells_labels_counts_and_range(self):
        done = harness.bccskel("info", self.image, "--json")
        image = json.loads(done.stdout)["image"]
        self.assertIn(": several labels are taken for one object; --label selects some", done.stderr)
        values, counts = numpy.unique(touching_labels(), return_counts=True)
        self.assertEqual(image["values"]["labels"],
                         [{"label": int(v), "voxels": int(n)} for v, n in zip(values, counts) if v])
        self.assertEqual((image["values"]["low"], image["values"]["high"]), (0, HUGE))
        text = harness.bccskel("info", self.image).stdout
        self.assertIn(f"values:      0 to {HUGE}\n", text)
        self.assertRegex(text, r"labels:      1 \(1 voxel\), 3 \(")

    def test_info_of_measured_values_tells_no_labels(self):
        numpy.save(self.image, numpy.array([-0.1, 2.5, numpy.nan, 7], "<f4").reshape(1, 2, 2))
        done = harness.bccskel("info", self.image, "--json")
        self.assertIn(": 1 voxel is NaN, which counts as background\n", done.stderr)
        image = json.loads(done.stdout)["image"]
        self.assertEqual(image["values"], {"low": -0.1, "high": 7, "not_numbers": 1})

    def test_a_label_without_voxels_beside_others_is_told(self):
        numpy.save(self.image, numpy.full((4, 4, 4), 7, "u1"))
        words = ("labels", self.image, "--local", "-o", self.path("a.csv"), "--labels")
        self.assertIn("no voxel has the label 9, 70\n", harness.bccskel(*words, "7,70,9").stderr)
        self.assertNotIn("no voxel", harness.bccskel(*words, "7-9").stderr)
        few = numpy.full((4, 4, 4), 7, "u1")
        few[0, 0, 0] = 10
        numpy.save(self.image, few)
        fewer = "fewer than 2 voxels (--min-voxels) have the label 10, 70\n"
        self.assertIn(fewer, harness.bccskel(*words, "7,10,70", "--min-voxels", 2).stderr)

    def test_wrong_wishes_are_told(self):
        for words, code, message in (
                (("-o", self.path("a.swc")), 2, "{label}"),
                (("-o", self.path("{label}.xyz")), 2, "no output format"),
                (("--label", "77", "-o", self.path("a.vtp")), 3,
                 "no voxel has the label 77; "),
                (("--min-voxels", "1M", "-o", self.path("a.vtp")), 3,
                 "no requested label has 1000000 voxels or more (--min-voxels); "),
                (("--label", "0", "-o", self.path("a.vtp")), 2, "background"),
                (("-o", self.path("missing/{label}.swc")), 8, "missing")):
            with self.subTest(words):
                done = harness.bccskel("labels", self.image, *words)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(message, done.stderr)

    def test_values_that_are_no_labels_are_told(self):
        for values, word in (([0.0, 1.5], "1.5"), ([0.0, -2.0], "-2")):
            numpy.save(self.image, numpy.array(values).reshape(1, 1, 2))
            done = harness.bccskel("labels", self.image, "-o", self.path("a.vtp"))
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn(word, done.stderr)
            self.assertIn("labels are whole numbers from 0 on; of gray levels, bccskel skeletonize "
                          "--threshold takes the brighter voxels for one object\n", done.stderr)

    def test_gray_levels_that_are_no_labels_come_with_a_threshold(self):
        dark, bright = numpy.random.default_rng(1).random((2, 8, 40, 40))
        image = numpy.concatenate((dark, 5 + bright), axis=2)
        for values in (image - 3, (100 * image - 300).astype("i2")):
            numpy.save(self.image, values)
            done = self.fail_with(3, "labels are whole numbers", "labels", self.image,
                                  "-o", self.path("a.vtp"))
            threshold = float(re.search(r"--threshold (\S+) \(Otsu's\)", done.stderr)[1])
            self.assertGreater(threshold, values[:, :, :40].max())
            self.assertLess(threshold, values[:, :, 40:].min())
            self.assertIn("; --below 0 takes the inside of a level set\n", done.stderr)


if __name__ == "__main__":
    harness.main()
