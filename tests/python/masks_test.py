"""Arrays of every kind give the skeleton that the command line makes of the same file."""

import json
import warnings

import bccskel
import harness
import numpy

from shapes import crossing_bars


class MasksTest(harness.TestCase):
    def digest(self, array, *words):
        """What the command line says of an array."""
        numpy.save(self.path("mask.npy"), array)
        return json.loads(self.succeed(
            "skeletonize", self.path("mask.npy"), "--local", "--json", *words, "-o",
            self.path("out.json")))["sha256"]

    def test_the_digest_is_the_command_line_s(self):
        mask = crossing_bars().astype("u1")
        options = {
            "": {},
            "--method directional --distance chamfer": dict(method="directional",
                                                            distance="chamfer"),
            "--kind surface --pruning-threshold 0.9": dict(kind="surface", pruning_threshold=0.9),
            "--pruning none --merge-junctions 0": dict(pruning="none", merge_junctions=0),
            "--voxel-points 16": dict(voxel_points=16),
            "--adjacency 6,26 --fill-cavities": dict(adjacency="6,26", fill_cavities=True),
            "--threshold 1 --min-component 2": dict(threshold=1, min_component=2),
            "--border continues": dict(border="continues"),
        }
        digests = set()
        for words, names in options.items():
            with self.subTest(words):
                digest = bccskel.skeletonize(mask, **names).sha256
                self.assertEqual(digest, self.digest(mask, *words.split()))
                digests.add(digest)
        self.assertGreater(len(digests), 4)

    def test_the_spacing_is_the_command_line_s(self):
        mask = crossing_bars().astype("u1")
        for spacing in ((3.0, 1.0, 0.5), 0.25):
            z, y, x = numpy.broadcast_to(spacing, 3)
            digest = bccskel.skeletonize(mask, spacing=spacing).sha256
            self.assertEqual(digest, self.digest(mask, "--voxel-size", f"{x},{y},{z}"))

    def test_every_type_and_stride_gives_the_same(self):
        mask = crossing_bars()
        wide = numpy.zeros(tuple(2 * n for n in mask.shape), "f4")
        wide[::2, ::2, ::2] = mask
        forms = {name: mask.astype(name) for name in
                 ("?", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8", "g", ">i4",
                  ">f8")}
        forms["fortran"] = numpy.asfortranarray(mask.astype("i2"))
        forms["every second"] = wide[::2, ::2, ::2]
        forms["backward"] = numpy.ascontiguousarray(mask[::-1, ::-1, ::-1])[::-1, ::-1, ::-1]
        forms["read-only"] = mask.copy()
        forms["read-only"].flags.writeable = False
        forms["unaligned"] = numpy.frombuffer(b"." + mask.astype("f8").tobytes(), "f8",
                                              offset=1).reshape(mask.shape)
        forms["masked"] = numpy.ma.array(numpy.ones(mask.shape), mask=~mask)
        forms["nan"] = numpy.where(mask, 7.5, numpy.nan)
        forms["negative"] = numpy.where(mask, -1, 0)
        forms["image"] = bccskel.Image(mask, (1, 1, 1), (0, 0, 0), numpy.eye(3))
        expected = bccskel.skeletonize(mask).sha256
        for name, form in forms.items():
            with self.subTest(name):
                self.assertEqual(bccskel.skeletonize(form).sha256, expected)

    def test_axes_name_the_order_of_everything(self):
        mask = crossing_bars()
        one = bccskel.skeletonize(mask, spacing=(3, 2, 1), origin=(10, 20, 30))
        other = bccskel.skeletonize(mask.transpose(2, 0, 1), spacing=(1, 3, 2),
                                    origin=(30, 10, 20), axes="xzy")
        self.assertEqual(one.sha256, other.sha256)
        numpy.testing.assert_array_equal(one.nodes[:, [2, 0, 1]], other.nodes)
        numpy.testing.assert_array_equal(one.paths[0][:, [2, 0, 1]], other.paths[0])

    def test_curves_lie_in_the_mask(self):
        mask = crossing_bars()
        skeleton = bccskel.skeletonize(mask, spacing=(3, 2, 1), origin=(10, 20, 30))
        points = (numpy.concatenate(skeleton.paths) - [10, 20, 30]) / [3, 2, 1]
        for corner in numpy.ndindex(2, 2, 2):  # each in one of the voxels around it
            voxels = tuple((numpy.floor(points).astype(int) + corner).T)
            points = points[~mask[voxels]]
        self.assertEqual(len(points), 0)

    def test_a_direction_turns_the_world(self):
        mask = crossing_bars()
        turn = numpy.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        plain = bccskel.skeletonize(mask, spacing=2)
        turned = bccskel.skeletonize(mask, spacing=2, direction=turn, origin=(5, 6, 7))
        numpy.testing.assert_allclose(turned.nodes, plain.nodes @ turn.T + [5, 6, 7])
        table, plain_table = turned.to_pandas(), plain.to_pandas()
        self.assertEqual(table.filter(like="image").values.tolist(),
                         plain_table.filter(like="image").values.tolist())

    def test_rules_choose_the_voxels(self):
        values = numpy.where(crossing_bars(), 5, 0).astype("i2")
        values[0, 0, 0] = 9
        expected = bccskel.skeletonize(values == 5).sha256
        for rule in (dict(label=5), dict(labels=[5, 6]), dict(range=(3, 8))):
            self.assertEqual(bccskel.skeletonize(values, **rule).sha256, expected)
        both = bccskel.skeletonize(values != 0).sha256
        for rule in (dict(threshold=5), dict(range=(1, None))):
            self.assertEqual(bccskel.skeletonize(values, **rule).sha256, both)
        self.assertEqual(bccskel.skeletonize(-values, below=0).sha256, both)

    def test_an_empty_mask_has_an_empty_skeleton(self):
        with self.assertWarns(UserWarning):
            skeleton = bccskel.skeletonize(numpy.zeros((4, 5, 6)))
        self.assertEqual((skeleton.nodes.shape, skeleton.edges.shape), ((0, 3), (0, 2)))
        self.assertEqual(len(skeleton.to_pandas()), 0)
        self.assertEqual(len(skeleton.to_networkx()), 0)

    def test_images_of_thick_slices_show_every_voxel(self):
        mask = numpy.zeros((9, 30, 20), bool)
        mask[2:7, 4:26, 5:15] = True
        for voxel_points in (2, 16):
            for array, spacing in ((mask, (8, 1, 1)), (mask.T, (1, 1, 8))):
                skeleton = bccskel.skeletonize(array, spacing=spacing, voxel_points=voxel_points)
                numpy.testing.assert_array_equal(skeleton.branch_image() > 0, array)
                self.assertTrue(array[skeleton.curve_image() > 0].all())

    def test_gray_levels_taken_for_a_mask_are_warned_of(self):
        gray = numpy.random.default_rng(1).normal(100, 9, (20, 20, 20))
        with self.assertWarnsRegex(UserWarning, "look like gray levels, .*; threshold=1?[0-9]{2}"):
            bccskel.skeletonize(gray)

    def test_a_sampling_that_changes_the_topology_warns(self):
        noise = numpy.random.default_rng(1).random((20, 20, 20)) > 0.6
        with self.assertWarnsRegex(UserWarning, "sampling changed the topology: "):
            skeleton = bccskel.skeletonize(noise, sampling="nearest", density=0.5)
        self.assertFalse(skeleton.certificate["topology_kept"])


class LabelsTest(harness.TestCase):
    def test_every_label_is_the_command_line_s(self):
        image = numpy.zeros((30, 40, 50), "i4")
        image[:, :20][crossing_bars()[:30, :20, :50]] = 3
        image[5:9, 25:35, 3:40] = 2 ** 30
        image[0, 0, 0] = 8
        numpy.save(self.path("labels.npy"), image)
        summary = json.loads(self.succeed("labels", self.path("labels.npy"), "--json",
                                          "--min-voxels", "2", "-o", self.path("all.vtp")))
        expected = {label["label"]: label["sha256"] for label in summary["labels"]}
        for form in (image, image.astype("f4"), image[::-1].copy()[::-1]):
            skeletons = bccskel.skeletonize_labels(form, min_voxels=2)
            self.assertEqual({n: s.sha256 for n, s in skeletons.items()}, expected)
        bccskel.save_labels(self.path("mine.vtp"), skeletons)
        with open(self.path("all.vtp"), "rb") as one, open(self.path("mine.vtp"), "rb") as other:
            self.assertEqual(one.read(), other.read())
        skeletons[3].save(self.path("three.html"))
        with self.assertWarnsRegex(UserWarning, "does not state its unit"):
            bccskel.save_labels(self.path("mine.precomputed"), skeletons)

    def test_notes_are_those_of_the_first_labels(self):
        image = numpy.zeros((9, 9, 60), "u1")
        for label in range(1, 6):
            image[1:8, 1:8, 10 * label:10 * label + 7] = label
            image[4, 4, 10 * label + 3] = 0
        with self.assertWarns(UserWarning) as told:
            skeletons = bccskel.skeletonize_labels(image)
        texts = [str(warning.message) for warning in told.warnings]
        self.assertEqual([text[:32] for text in texts[:3]],
                         [f"label {n}: 1 cavity leaves a close" for n in (1, 2, 3)])
        self.assertIn("notes on 2 more labels", texts[3])
        numpy.save(self.path("hollow.npy"), image)
        done = harness.bccskel("labels", self.path("hollow.npy"), "--json", "-o",
                               self.path("hollow.csv"))
        self.assertIn("warning: " + self.path("hollow.npy") + ": label 3: 1 cavity", done.stderr)
        self.assertIn("notes on 2 more labels; --json shows all", done.stderr)
        self.assertEqual([len(label["notes"]) for label in json.loads(done.stdout)["labels"]],
                         [len(skeletons[n].notes) for n in range(1, 6)])

    def test_labels_of_no_voxel_are_named(self):
        image = numpy.ones((4, 4, 4), "u1")
        with self.assertRaisesRegex(ValueError, "^no voxel has the label 5 or 7; the image has 1 label: 1$"):
            bccskel.skeletonize_labels(image, labels=[5, 7])
        self.assertEqual(list(bccskel.skeletonize_labels(image, labels=[1, 5])), [1])
        self.assertEqual(bccskel.skeletonize_labels(image, labels=1, min_voxels=65), {})
        self.assertEqual(bccskel.skeletonize_labels(0 * image), {})

    def test_voxels_that_are_no_labels_are_told(self):
        image = numpy.ones((4, 4, 4))
        image[0, 0, :2] = numpy.nan
        with self.assertWarnsRegex(UserWarning, "^2 voxels are NaN, which counts as background$"):
            self.assertEqual(bccskel.skeletonize_labels(image)[1].voxels, 62)
        for nothing in (numpy.zeros((2, 3, 4)), numpy.full((2, 3, 4), numpy.nan)):
            with self.assertWarnsRegex(UserWarning, "^no voxel has a label: all are 0"):
                self.assertEqual(bccskel.skeletonize_labels(nothing), {})

    def test_gray_levels_are_no_labels(self):
        gray = numpy.random.default_rng(1).integers(0, 200, (8, 40, 40), "u1")
        with self.assertWarnsRegex(UserWarning, "^the values look like gray levels, not labels, and "
                                   r"each value is an object; skeletonize\(image, threshold="):
            bccskel.skeletonize_labels(gray)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            bccskel.skeletonize_labels(gray, labels=[7])
            bccskel.skeletonize_labels(gray, label=7)
            bccskel.skeletonize_labels(crossing_bars() * 3)

    def test_fractions_and_negative_labels_are_refused(self):
        for value in (1.5, -1.0):
            with self.assertRaisesRegex(ValueError, "whole number"):
                bccskel.skeletonize_labels(numpy.full((2, 2, 2), value))


if __name__ == "__main__":
    harness.main()
