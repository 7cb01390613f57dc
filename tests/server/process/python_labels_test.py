"""The documented Python client for labels against a server: a numpy array in, a graph per label."""

import tempfile
import unittest

import numpy as np

from interface import EXAMPLES, Code, ServerTest, example, labels_example, run_python

RING, BAR, BLOCK = 3, (1 << 40) + 7, (1 << 64) - 1


def image():
    """A ring with a bar through it that touches it, and a block, as uint64."""
    z, y, x = np.indices((12, 31, 45))
    volume = np.zeros(z.shape, dtype=np.uint64)
    volume[:, 20:, 36:] = BLOCK
    volume[(abs(y - 15) <= 2) & (abs(z - 5) <= 2)] = BAR
    volume[np.hypot(np.hypot(x - 15, y - 15) - 10, z - 5) <= 3] = RING
    return volume


class LabelsTest(ServerTest):
    def skeletons(self, volume, **kwargs):
        return dict(labels_example.skeletonize_labels(self.channel, volume, **kwargs))

    def test_each_label_gets_the_graph_that_it_has_as_a_mask(self):
        volume, seen = image(), []
        skeletons = self.skeletons(volume, spacing=(1.0, 1.0, 2.0),
                                   on_progress=lambda p: seen.append((p.done, p.total)))
        self.assertEqual(list(skeletons), [RING, BAR, BLOCK])
        self.assertEqual(seen[-1], (3, 3))
        for label, skeleton in skeletons.items():
            alone = example.skeletonize(self.channel, volume == label, spacing=(1.0, 1.0, 2.0))
            self.assertEqual(skeleton.summary.sha256, alone.summary.sha256)
            self.assertEqual(skeleton.summary.certificate, alone.summary.certificate)
            np.testing.assert_array_equal(skeleton.node, alone.node)
            np.testing.assert_array_equal(np.concatenate(skeleton.radii),
                                          np.concatenate(alone.radii))
        self.assertEqual(skeletons[RING].summary.certificate.mask.loops, 1)

    def test_any_integer_type_and_order_of_bytes(self):
        volume = image()
        small = np.select([volume == RING, volume == BAR, volume == BLOCK], [1, 2, 3])
        digests = [s.summary.sha256 for s in self.skeletons(volume).values()]
        for kind in ("u1", "<u2", ">u2", "<u4", ">u8"):
            skeletons = self.skeletons(small.astype(kind))
            self.assertEqual(list(skeletons), [1, 2, 3], kind)
            self.assertEqual([s.summary.sha256 for s in skeletons.values()], digests, kind)

    def test_what_is_no_label_is_refused_and_signed_integers_are_taken(self):
        mask = image() == RING
        for kind in (bool, "i2", ">i8"):
            self.assertEqual(list(self.skeletons(mask.astype(kind))), [1], kind)
        for wrong, error in ((mask.astype("f4"), TypeError), (-mask.astype("i2"), ValueError),
                             (mask[0].astype("u1"), ValueError)):
            with self.assertRaises(error):
                self.skeletons(wrong)
        with self.assertRaises(ValueError):
            self.skeletons(mask, spacing=(1, 2))

    def test_listed_labels_and_a_least_size(self):
        self.assertEqual(list(self.skeletons(image(), labels=[BLOCK, 12, RING])), [RING, BLOCK])
        few = image()
        few[0, 0, 0] = 99
        self.assertEqual(list(self.skeletons(few, min_voxels=2)), [RING, BAR, BLOCK])

    def test_a_volume_without_labels(self):
        self.assertEqual(self.skeletons(np.zeros((3, 4, 5), dtype=np.uint8)), {})

    def test_the_reason_of_an_error_can_be_read(self):
        self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                   lambda: self.skeletons(image(), labels=[0]))

    def test_the_script_runs_as_documented(self):
        with tempfile.NamedTemporaryFile(suffix=".npy") as file:
            np.save(file, image())
            file.flush()
            ended = run_python(EXAMPLES / "skeletonize_labels.py", file.name,
                               "--server", self.server.address)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("label 3:", ended.stdout)
        self.assertIn("1 components, 1 loops, 0 cavities", ended.stdout)


if __name__ == "__main__":
    unittest.main()
