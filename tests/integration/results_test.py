"""Commands that read a result and its object again: what they make of both."""

import json

import numpy as np

import harness

# A box with edges of 4, 3 and 2.
BOX = """OFF
8 6 0
0 0 0
4 0 0
4 3 0
0 3 0
0 0 2
4 0 2
4 3 2
0 3 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


class ResultsTest(harness.TestCase):
    def skeletonize(self, volume, *options):
        """The JSON result."""
        done = harness.bccskel("skeletonize", volume, "--local", *options,
                               "-o", self.path("s.json"))
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.read_json("s.json")

    def reconstruct(self, *options):
        """The JSON summary; nothing is warned of."""
        return json.loads(self.succeed("reconstruct", self.path("s.json"), *options,
                                       "-o", self.path("balls.bccb"), "--json"))

    def test_the_balls_of_a_torus_cover_it(self):
        volume = self.generate("torus")
        self.skeletonize(volume)
        summary = self.reconstruct("--object", volume)
        self.assertEqual(summary["points"], summary["common_points"])
        self.assertGreater(summary["jaccard"], 0.9)

    def test_a_surface_skeleton_is_in_the_result_with_all_points(self):
        volume = self.generate("box")
        result = self.skeletonize(volume, "--kind", "surface", "-o", self.path("thin.bccb"))
        thin = json.loads(self.succeed("info", self.path("thin.bccb"), "--json"))["volume"]
        places = {tuple(node["position"]) for node in result["nodes"]}
        for part in (*result["edges"], result["sheets"]):
            self.assertEqual(len(part["points"]), len(part["radii"]))
            places.update(map(tuple, part["points"]))
        self.assertEqual(len(places), thin["points"])
        summary = self.reconstruct("--object", volume)
        self.assertEqual(summary["points"], summary["common_points"])
        self.assertGreater(summary["jaccard"], 0.9)

    def test_a_surface_skeleton_comes_from_a_server_as_it_is_here(self):
        volume = self.generate("box")
        here = self.skeletonize(volume, "--kind", "surface")
        with harness.Server(self.folder) as server:
            done = harness.bccskel("submit", volume, "--server", server.address, "--kind",
                                   "surface", "-o", self.path("there.json"))
        self.assertEqual(done.returncode, 0, done.stderr)
        there = self.read_json("there.json")
        self.assertEqual(harness.without_times(there), harness.without_times(here))

    def test_the_object_is_prepared_as_the_result_says(self):
        volume = self.generate("hollow-ball")
        result = self.skeletonize(volume, "--fill-cavities")
        summary = self.reconstruct("--object", volume)
        self.assertEqual(summary["points"], summary["common_points"])
        self.assertGreater(summary["points"], 20000)  # of what is full now
        self.assertGreater(result["object_points"], summary["points"])
        for command in ("render", "view"):
            ending = {"render": "png", "view": "html"}[command]
            self.succeed(command, self.path("s.json"), "--object", volume,
                         "-o", self.path("x." + ending))

    def test_a_mesh_is_filled_on_the_grid_of_the_result(self):
        mesh = self.write("box.off", BOX)
        for grid in (("--points", 3000), ("--spacing", 0.23)):
            self.skeletonize(mesh, *grid)
            summary = self.reconstruct("--object", mesh)  # which would warn of another number
            self.assertEqual(summary["points"], summary["common_points"])

    def test_balls_may_reach_beyond_a_border_that_continues_as_on_a_server(self):
        voxels = np.zeros((30, 40, 40), np.uint8)
        z, y, x = np.ogrid[:30, :40, :40]
        voxels[((y - 20) ** 2 + (x - 20) ** 2 < 14 ** 2) & (z >= 0)] = 1
        np.save(self.folder / "rod.npy", voxels)
        rod = self.path("rod.npy")
        with harness.Server(self.folder) as server:
            for command, source in (("submit", self.generate("box")), ("skeletonize", rod)):
                here = self.skeletonize(source, "--border", "continues")
                self.succeed(command, source, "--border", "continues", "--server", server.address,
                             "-o", self.path("there.json"))
                there = self.read_json("there.json")
                self.assertEqual(harness.without_times(there), harness.without_times(here))
        summary = self.reconstruct("--object", rod)
        self.assertGreater(summary["jaccard"], 0.9)
        self.succeed("view", self.path("s.json"), "--object", rod, "-o", self.path("x.html"))

    def test_balls_reach_beyond_a_border_that_cuts_a_limb(self):
        z, y, x = np.ogrid[:30, :80, :60]
        np.save(self.folder / "rod.npy", (y - 40) ** 2 + (x - 15 - z) ** 2 < 10 ** 2)
        rod = self.path("rod.npy")
        ends = [node for node in self.skeletonize(rod)["nodes"] if node["kind"] == "end"]
        self.assertEqual(len(ends), 2)
        for end in ends:  # on the faces, with the limb's radius
            self.assertLess(abs(abs(end["position"][2] - 14.5) - 15), 0.6)
            self.assertAlmostEqual(end["radius"], 10 / 2 ** 0.5, delta=0.7)
        self.reconstruct("--object", rod)
        self.succeed("view", self.path("s.json"), "--object", rod, "-o", self.path("x.html"))

    def test_balls_reach_beyond_the_faces_of_one_slice_as_on_a_server(self):
        y, x = np.ogrid[:40, :60]
        np.save(self.folder / "disc.npy", ((y - 20) ** 2 + (x - 30) ** 2 < 14 ** 2)[None])
        disc = self.path("disc.npy")
        here = self.skeletonize(disc)
        self.assertEqual(here["options"]["border"], "slice")
        self.assertGreater(here["totals"]["max_radius"], 13)
        with harness.Server(self.folder) as server:
            self.succeed("skeletonize", disc, "--server", server.address, "-o",
                         self.path("there.json"))
        there = self.read_json("there.json")
        self.assertEqual(harness.without_times(there), harness.without_times(here))
        self.reconstruct("--object", disc)
        self.succeed("view", self.path("s.json"), "--object", disc, "-o", self.path("x.html"))

    def test_a_picture_beside_a_result_is_the_one_that_render_draws(self):
        source = self.generate("tree")
        self.skeletonize(source, "-o", self.path("beside.png"))
        self.succeed("render", self.path("s.json"), "--object", source, "-o",
                     self.path("rendered.png"))
        self.assertEqual((self.folder / "beside.png").read_bytes(),
                         (self.folder / "rendered.png").read_bytes())

    def test_another_object_is_refused(self):
        self.skeletonize(self.generate("tree"))
        thin = self.tetrahedron("thin.off", 1e-3, 1e-3, 1e-3)  # between the points of the grid
        others = [(self.write("box.off", BOX), "box along the axis"),  # elsewhere
                  (thin, "it has no point on the result's grid"),
                  (self.generate("ball", 5000, "small.bccb"), "is not what"),
                  (self.generate("ball", 5000000, "large.bccb"), "its volume is")]
        for other, why in others:
            for command, output in (("view", "x.html"), ("render", "x.png"),
                                    ("reconstruct", "x.bccb")):
                with self.subTest(command=command, other=other):
                    done = self.fail_with(3, why, command, self.path("s.json"),
                                          "--object", other, "-o", self.path(output))
                    self.assertIn(other, done.stderr)
                    self.assertFalse((self.folder / output).exists())

    def test_the_same_object_in_another_grid_is_warned_of(self):
        box = self.write("box.off", BOX)
        self.skeletonize(box, "--points", 3000)
        done = harness.bccskel("reconstruct", self.path("s.json"), "--object", box, "--points", 20000, "-o",
                               self.path("x.bccb"), "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"warning: .*box.off: has [\d,]+ points, but .*s.json was")


if __name__ == "__main__":
    harness.main()
