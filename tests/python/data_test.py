"""Files of real objects give the command line's digests."""

import json
import unittest.mock

import bccskel
import harness


@harness.needs_data("volume")
class DataTest(harness.TestCase):
    def theirs(self, path, *words):
        done = harness.bccskel("skeletonize", path, "--local", "--json", *words, "-o",
                               self.path("out.json"))
        return json.loads(done.stdout)["sha256"]

    def test_images(self):
        for name in ("cat10b.vol", "airway_p4_chopped.nrrd", "liver.inr.gz",
                     "neuron_28794499.nrrd"):
            with self.subTest(name), unittest.mock.patch("warnings.warn"):
                path = harness.DATA / "volume" / name
                skeleton = bccskel.skeletonize(bccskel.read(path))
                self.assertEqual(skeleton.sha256, self.theirs(path))
                self.assertTrue(skeleton.certificate["topology_kept"])

    def test_meshes(self):
        for name in ("spot.obj", "boot.obj.gz"):
            with self.subTest(name), unittest.mock.patch("warnings.warn"):
                path = harness.DATA / "mesh" / name
                mesh = bccskel.read(path)
                self.assertEqual(bccskel.skeletonize_mesh(mesh, points=30000).sha256,
                                 self.theirs(path, "--points", 30000))


if __name__ == "__main__":
    harness.main()
