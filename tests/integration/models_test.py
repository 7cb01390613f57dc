"""Real meshes through the server; the loops that their makers gave them must come out."""

import json

import harness

MODELS = [  # file, points, (components, loops, cavities)
    ("elephant.off", 200_000, (1, 3, 0)),
    ("fertility.off", 100_000, (1, 4, 0)),
    ("knot2.off", 100_000, (2, 2, 0)),
]


@harness.needs_data("mesh")
class ModelsTest(harness.TestCase):
    def test_skeletons_keep_the_loops_of_the_solid(self):
        with harness.Server(self.folder) as server:
            for name, points, topology in MODELS:
                with self.subTest(name):
                    summary = json.loads(self.succeed(
                        "skeletonize", harness.DATA / "mesh" / name, "--points", points, "--json",
                        "--server", server.address, "-o", self.path("s.swc")))
                    betti = summary["certificate"]["skeleton"]
                    self.assertEqual(harness.topology(betti), topology)
                    self.assertEqual(summary["mesh"]["solid"], betti)
                    self.assertEqual(summary["certificate"]["simple_points_left"], 0)
                    self.assertEqual(
                        summary["edges"] - summary["nodes"] + topology[0], topology[1])
                    self.assertLess(abs(summary["object_points"] - points), 0.03 * points)


if __name__ == "__main__":
    harness.main()
