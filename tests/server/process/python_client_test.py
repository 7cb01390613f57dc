"""The documented Python client against a server: the interface from the .proto files alone."""

import os
import re
import tempfile
import unittest

import numpy as np

from interface import EXAMPLES, SOURCE, Code, ServerTest, example, run_python


class ExampleTest(ServerTest):
    def skeletonize(self, cells, **kwargs):
        return example.skeletonize(self.channel, cells, **kwargs)

    def check_graph(self, skeleton, cells):
        """What the interface promises about any graph."""
        betti = skeleton.summary.certificate.skeleton
        self.assertEqual(skeleton.summary.certificate.input, betti)
        self.assertEqual(skeleton.summary.object_points, int(cells.sum()))
        # Only closed surfaces hold loops of their own, and these objects have none.
        self.assertEqual(betti.loops,
                         len(skeleton.ends) - len(skeleton.node) + betti.components)
        self.assertEqual(len(skeleton.summary.sha256), 32)
        for (source, target), path, radii in zip(skeleton.ends, skeleton.paths, skeleton.radii):
            self.assertTrue((path[0] == skeleton.node[source]).all())
            self.assertTrue((path[-1] == skeleton.node[target]).all())
            steps = np.abs(np.diff(path, axis=0)).sum(axis=1)
            self.assertTrue(np.isin(steps, (2, 3)).all())
            self.assertTrue((radii > 0).all())
            i, j, k = (path // 2).T
            self.assertTrue(cells[path[:, 0] % 2, i, j, k].all(), "a point is not in the object")

    def test_a_torus_has_one_loop(self):
        cells = example.torus()
        skeleton = self.skeletonize(cells)
        self.check_graph(skeleton, cells)
        self.assertEqual(skeleton.summary.certificate.skeleton.loops, 1)
        # The tube's radius is 8 lattice units, 4 cells.
        self.assertAlmostEqual(float(np.median(np.concatenate(skeleton.radii))), 4.0, delta=0.6)

    def test_axes_are_not_mixed_up(self):
        cells = np.zeros((2, 40, 12, 70), dtype=bool)
        cells[:, 3:37, 4:8, 30:34] = True  # a bar along x
        cells[:, 3:7, 4:8, 5:66] = True    # a bar along z
        skeleton = self.skeletonize(cells)
        self.check_graph(skeleton, cells)
        points = np.concatenate(skeleton.paths)
        extent = points.max(axis=0) - points.min(axis=0)
        self.assertGreater(extent[2], 90)
        self.assertTrue(50 < extent[0] < 80 and extent[1] < 12, extent)

    def test_noise_of_many_parts(self):
        cells = np.random.default_rng(3).random((2, 9, 14, 45)) < 0.06
        skeleton = self.skeletonize(cells)
        self.assertEqual(skeleton.summary.certificate.input,
                         skeleton.summary.certificate.skeleton)
        self.assertGreater(skeleton.summary.certificate.skeleton.components, 50)

    def test_an_empty_volume_gives_an_empty_graph(self):
        skeleton = self.skeletonize(np.zeros((2, 3, 3, 3), dtype=bool))
        self.assertEqual((len(skeleton.node), len(skeleton.ends), skeleton.paths), (0, 0, []))

    def test_progress_comes_and_spacing_scales_radii(self):
        shells = []
        fine = self.skeletonize(example.torus(), spacing=0.5,
                                on_progress=lambda progress: shells.append(progress.shell))
        coarse = self.skeletonize(example.torus(), spacing=1.0)
        self.assertEqual(shells, sorted(set(shells)))
        self.assertEqual(shells[-1], fine.summary.last_shell)
        self.assertEqual(fine.summary.sha256, coarse.summary.sha256)
        np.testing.assert_allclose(np.concatenate(coarse.radii), 2 * np.concatenate(fine.radii))

    def ring(self, spacing):
        """A mask of a ring of radius 20 and thickness 12 around the z axis, in world units."""
        shape = [int(np.ceil(extent / step)) for extent, step in zip((20, 60, 60), spacing[::-1])]
        z, y, x = (axis * step + step / 2 for axis, step in zip(np.indices(shape), spacing[::-1]))
        return (np.hypot(x - 30, y - 30) - 20) ** 2 + (z - 10) ** 2 <= 6 ** 2

    def test_a_mask_keeps_its_loop_and_its_world(self):
        spacing, origin = np.array([1.0, 0.5, 2.0]), np.array([100.0, -50.0, 7.0])
        mask = self.ring(spacing)
        skeleton = self.skeletonize(mask, spacing=spacing, origin=origin)
        certificate = skeleton.summary.certificate
        self.assertEqual(certificate.mask, certificate.input)
        self.assertEqual(certificate.mask, certificate.skeleton)
        self.assertEqual(certificate.mask.loops, 1)
        points = skeleton.world(np.concatenate(skeleton.paths)) - origin + spacing / 2
        self.assertLess(np.abs(np.hypot(points[:, 0] - 30, points[:, 1] - 30) - 20).max(), 2.5)
        self.assertLess(np.abs(points[:, 2] - 10).max(), 2.5)
        self.assertAlmostEqual(float(np.median(np.concatenate(skeleton.radii))), 6, delta=1)

    def test_the_bricks_of_a_mask_are_not_underestimated(self):
        random = np.random.default_rng(5)
        for shape in ((1, 1, 1), (4, 2, 8), (5, 3, 9), (13, 21, 40)):
            for share in (0.002, 0.1, 1.0):
                mask = random.random(shape) < share
                self.assertEqual(self.skeletonize(mask).summary.certificate.mask.components > 0,
                                 mask.any())

    def test_a_graph_comes_of_a_mask(self):
        skeleton = self.skeletonize(self.ring(np.array([1.0, 1.0, 1.0])))
        graph = skeleton.to_networkx()
        self.assertEqual(graph.number_of_edges() - graph.number_of_nodes(), 0)
        self.assertAlmostEqual(sum(d["length"] for _, _, d in graph.edges(data=True)),
                               2 * np.pi * 20, delta=6)

    def swc(self, skeleton):
        """The comments and the rows of its SWC file."""
        with tempfile.NamedTemporaryFile(suffix=".swc", mode="r") as file:
            skeleton.write_swc(file.name)
            lines = file.read().splitlines()
        comments = [line for line in lines if line.startswith("#")]
        return comments, np.array([row.split() for row in lines[len(comments):]], float)

    def test_an_swc_file_holds_the_smooth_curves(self):
        skeleton = self.skeletonize(self.ring(np.array([1.0, 1.0, 1.0])))
        comments, rows = self.swc(skeleton)
        self.assertEqual(len(rows), skeleton.summary.skeleton_points)
        self.assertEqual((rows[:, 6] == -1).sum(), 1)
        self.assertTrue((rows[1:, 6] < rows[1:, 0]).all(), "a parent comes after its child")
        parents = rows[rows[1:, 6].astype(int) - 1, 2:5]
        length = np.linalg.norm(rows[1:, 2:5] - parents, axis=1).sum()
        self.assertAlmostEqual(length, 2 * np.pi * 20, delta=6)
        self.assertIn("1 tree", comments[0])
        self.assertIn("1 loop cut", "\n".join(comments))
        self.assertEqual(comments[-1], "# id type x y z radius parent")

    def test_an_swc_file_states_ends_junctions_and_points_without_edge(self):
        cells = np.zeros((40, 60, 90), dtype=bool)
        cells[5:15, 5:15, 5:85] = cells[5:15, 5:55, 40:50] = True  # a T
        cells[30, 30, 30] = True                                   # one voxel
        comments, rows = self.swc(self.skeletonize(cells))
        self.assertIn("2 trees", comments[0])
        self.assertNotIn("loop", "\n".join(comments))
        self.assertEqual((rows[:, 6] == -1).sum(), 2)
        self.assertEqual([(rows[:, 1] == kind).sum() for kind in (5, 6)], [1, 3])
        children = np.bincount(rows[rows[:, 6] > 0, 6].astype(int), minlength=len(rows) + 1)[1:]
        np.testing.assert_array_less(1, children[rows[:, 1] == 5] + 1)
        self.assertTrue((rows[:, 5] > 0).all())

    def test_voxels_that_are_not_a_number_are_background(self):
        mask = self.ring(np.array([1.0, 1.0, 1.0]))
        values = np.where(mask, np.inf, np.nan)
        values[:, :, :30] *= -1
        digest = self.skeletonize(mask).summary.sha256
        self.assertEqual(self.skeletonize(values).summary.sha256, digest)
        cells = example.torus()
        self.assertEqual(self.skeletonize(np.where(cells, 2.5, np.nan)).summary.sha256,
                         self.skeletonize(cells).summary.sha256)

    def test_an_array_of_another_shape_is_refused_with_its_shape(self):
        for shape in ((20, 30), (7,), (3, 9, 9, 9), (2, 2, 9, 9, 9)):
            with self.assertRaises(ValueError) as raised:
                self.skeletonize(np.ones(shape))
            self.assertIn(f"(2, nx, ny, nz), not {shape}", str(raised.exception))
        with self.assertRaises(ValueError):
            self.skeletonize(np.ones((4, 4, 4)), spacing=(1, 2))

    def test_curves_use_the_shifts_below_the_lattice(self):
        skeleton = self.skeletonize(example.torus())
        self.assertGreater(max(np.abs(shifts).max() for shifts in skeleton.shifts), 0)

        def offset(paths):
            x, y, z = (np.concatenate(paths) - (36, 36, 12)).T  # the middle of the torus
            return np.hypot(np.hypot(x, y) - 24, z).mean()

        moved = offset([2 * skeleton.curve(edge) for edge in range(len(skeleton.ends))])
        self.assertLess(moved, 0.3)
        self.assertLess(moved, 0.7 * offset([example.smoothed(path) for path in skeleton.paths]))

    def test_the_reason_of_an_error_can_be_read(self):
        error = self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                           lambda: self.skeletonize(example.torus(), spacing=-1.0))
        self.assertIn("spacing", error.details())

    def run_script(self, *arguments):
        return run_python(EXAMPLES / "skeletonize.py", "--server", self.server.address, *arguments)

    def run_script_on(self, array):
        with tempfile.NamedTemporaryFile(suffix=".npy") as file:
            np.save(file, array)
            file.flush()
            return self.run_script(file.name)

    def test_the_block_of_the_readme_runs_as_printed(self):
        readme = (SOURCE / "README.md").read_text()
        block = re.search(r"```python\n(.*?)```", readme, re.S)[1]
        self.assertEqual(block.count("127.0.0.1:50051"), 1)
        with tempfile.TemporaryDirectory() as folder:
            ended = run_python("-c", block.replace("127.0.0.1:50051", self.server.address),
                               cwd=folder)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertIn("loops: 1", ended.stdout)
            self.assertEqual(os.listdir(folder), ["skeleton.swc"])

    def test_the_script_runs_as_documented(self):
        ended = self.run_script_on(example.torus(30.0, 9.0))
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("1 components, 1 loops, 0 cavities", ended.stdout)
        self.assertIn("edge 0 - 0:", ended.stdout)

    def test_the_script_says_why_it_refuses_an_array(self):
        ended = self.run_script_on(np.ones((5, 6)))
        self.assertEqual(ended.returncode, 1)
        self.assertIn("not (5, 6)", ended.stderr)
        self.assertNotIn("Traceback", ended.stderr)

    def test_the_script_says_why_it_failed(self):
        ended = self.run_script("--spacing", "-1")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("INVALID_ARGUMENT (FIELD_INVALID)", ended.stderr)


if __name__ == "__main__":
    unittest.main()
