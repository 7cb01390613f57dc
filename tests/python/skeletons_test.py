"""What a skeleton says of itself as arrays, graph and table."""

import itertools

import bccskel
import harness
import networkx
import numpy

from shapes import ball, box_mesh, crossing_bars


class SkeletonsTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.mask = crossing_bars()
        self.skeleton = bccskel.skeletonize(self.mask, spacing=(2, 1, 1))

    def test_arrays_fit_together(self):
        s = self.skeleton
        self.assertEqual(sorted(s.node_kinds), ["end", "end", "end", "junction", "loop"])
        for edge, path, radii, length in zip(s.edges, s.paths, s.radii, s.lengths):
            self.assertEqual(path.shape, (len(radii), 3))
            if s.node_kinds[edge[0]] != "loop":  # which is smooth all around
                numpy.testing.assert_allclose(path[[0, -1]], s.nodes[edge], atol=1e-9)
            steps = numpy.linalg.norm(numpy.diff(path, axis=0), axis=1)
            self.assertAlmostEqual(steps.sum(), length)
            numpy.testing.assert_allclose(radii[[0, -1]], s.node_radii[edge])
        self.assertEqual(len(s.paths), len(s.edges))
        self.assertEqual(sorted(set(s.node_components)), [0, 1])
        self.assertEqual(s.voxels, self.mask.sum())

    def test_arrays_do_not_change_since_files_would_not(self):
        s = self.skeleton
        for array in (s.nodes, s.node_radii, s.node_kinds, s.edges, s.lengths, s.paths[0],
                      s.radii[0], s.sheets, s.pruning_levels):
            with self.assertRaisesRegex(ValueError, "read-only"):
                array[...] = array

    def test_the_certificate_counts(self):
        same = {"components": 2, "loops": 1, "cavities": 0}
        self.assertEqual(self.skeleton.certificate,
                         {"topology_kept": True, "mask": same, "input": same, "skeleton": same,
                          "sampled": False, "simple_points_left": 0})

    def test_the_table_has_the_columns_of_skan(self):
        table = self.skeleton.to_pandas()
        self.assertEqual(list(table)[:20], [
            "skeleton-id", "node-id-src", "node-id-dst", "branch-distance", "branch-type",
            "mean-pixel-value", "stdev-pixel-value", "image-coord-src-0", "image-coord-src-1",
            "image-coord-src-2", "image-coord-dst-0", "image-coord-dst-1", "image-coord-dst-2",
            "coord-src-0", "coord-src-1", "coord-src-2", "coord-dst-0", "coord-dst-1",
            "coord-dst-2", "euclidean-distance"])
        self.assertEqual(sorted(table["branch-type"]), [1, 1, 1, 3])
        numpy.testing.assert_allclose(table["mean-pixel-value"],
                                      [radii.mean() for radii in self.skeleton.radii])
        numpy.testing.assert_allclose(table["stdev-pixel-value"],
                                      [radii.std() for radii in self.skeleton.radii], atol=1e-12)
        beside = (table["coord-src-0"] / 2 - table["image-coord-src-0"]).abs()
        self.assertLessEqual(beside.max(), 0.5)
        self.assertTrue((table["branch-distance"] >= table["euclidean-distance"] - 1e-9).all())
        numpy.testing.assert_allclose(table["tortuosity"],
                                      table["branch-distance"] / table["euclidean-distance"].where(
                                          table["branch-type"] != 3))
        self.assertIn("branch_type", self.skeleton.to_pandas(separator="_"))
        mesh = bccskel.skeletonize_mesh(*box_mesh(), points=2000).to_pandas()
        self.assertNotIn("image-coord-src-0", mesh)

    def test_nodes_have_voxels_of_the_object(self):
        z, y, x = numpy.indices((20, 40, 40))
        limb = numpy.hypot(y - 20, z - 10) < 4
        noise = numpy.random.default_rng(3).random((24, 24, 24)) < 0.4
        cases = ((limb, dict(border="continues")), (noise, dict(pruning="none")),
                 (self.mask, dict(spacing=(2, 1, 1), axes="yxz", voxel_points=16)),
                 (numpy.ones((1, 1, 9), bool), dict(spacing=0.3, origin=(7, 8, 9))))
        for mask, options in cases:
            tables = [bccskel.skeletonize(mask, **options).to_pandas(),
                      bccskel.skeletonize_labels(mask.astype("u1"), **options)[1].to_pandas()]
            for table, end in itertools.product(tables, ("src", "dst")):
                voxels = table[[f"image-coord-{end}-{axis}" for axis in range(3)]].values
                self.assertTrue((voxels >= 0).all() and (voxels < mask.shape).all())
                self.assertTrue(mask[tuple(voxels.T)].all())
        sampled = bccskel.skeletonize(noise, sampling="nearest").to_pandas()
        voxels = sampled.filter(like="image").values
        self.assertTrue((voxels >= 0).all() and (voxels < 24).all())

    def test_the_graph_can_be_written_as_graphml(self):
        graph = self.skeleton.to_networkx()
        networkx.write_graphml(graph, self.path("graph.graphml"))
        read = networkx.read_graphml(self.path("graph.graphml"), force_multigraph=True)
        self.assertEqual(sorted(length for *_, length in read.edges(data="length")),
                         sorted(self.skeleton.lengths))
        self.assertEqual(networkx.number_connected_components(graph), 2)
        self.assertEqual(len(networkx.cycle_basis(networkx.Graph(graph))), 1)
        path = self.skeleton.to_networkx(points=True).edges[tuple(self.skeleton.edges[0]) + (0,)]
        numpy.testing.assert_array_equal(path["path"], self.skeleton.paths[0])

    def test_a_root_orders_the_trees(self):
        self.assertIsNone(self.skeleton.order)
        near = self.skeleton.nodes[0]
        ordered = bccskel.skeletonize(self.mask, spacing=(2, 1, 1), root=tuple(near))
        self.assertEqual(ordered.order["roots"][ordered.node_components[0]], 0)
        self.assertEqual(ordered.order["root_distance"][0], 0)
        self.assertFalse(ordered.order["root_distance"].flags.writeable)
        self.assertEqual(sorted(ordered.to_pandas()["generation"].dropna()), [0, 1, 1])
        self.assertIn("root_distance", ordered.to_networkx().nodes[0])

    def test_edges_that_close_loops_have_no_place_in_the_trees(self):
        ordered = bccskel.skeletonize(self.mask, root="thickest-end")
        closes = ordered.order["proximal"] < 0
        self.assertEqual(closes.sum(), 1)
        table, edges = ordered.to_pandas(), ordered.to_networkx().edges(keys=True, data=True)
        for name in ("generation", "strahler"):
            numpy.testing.assert_array_equal(numpy.isnan(ordered.order[name]), closes)
            numpy.testing.assert_array_equal(table[name].isna(), closes)
            for *_, number, facts in edges:
                self.assertEqual(name in facts, not closes[number])
                self.assertIsInstance(facts.get(name, 0), int)

    def test_a_root_outside_the_object_is_warned_of(self):
        with self.assertWarnsRegex(UserWarning, "the root is far from the skeleton, .* from the "
                                                "nearest node"):
            bccskel.skeletonize(self.mask, root=(1000, 0, 0))

    def test_surfaces_have_sheets(self):
        plate = numpy.zeros((9, 30, 30), bool)
        plate[3:6, 2:28, 2:28] = True
        sheets = bccskel.skeletonize(plate, kind="surface")
        self.assertGreater(len(sheets.sheets), 100)
        self.assertEqual(sheets.sheet_radii.shape, sheets.sheets.shape[:1])
        self.assertEqual(self.skeleton.sheets.shape[1], 3)

    def test_plates_are_noted_and_rows_of_voxels_are_not(self):
        for spacing, voxel_points in itertools.product(((1, 1, 1), (3, 1, 1), (2, 3, 4), (1, 1, 8)),
                                                       (2, 16)):
            options = dict(spacing=spacing, voxel_points=voxel_points)
            for axis, length in itertools.product(range(3), (1, 2, 3, 9, 30)):
                shape = numpy.ones(3, int)
                shape[axis] = length
                with self.subTest(shape, **options):
                    row = bccskel.skeletonize(numpy.pad(numpy.ones(shape), 1), **options)
                    self.assertEqual(row.notes, [])
            with self.assertWarnsRegex(UserWarning, "as in plates"):
                bccskel.skeletonize(numpy.pad(numpy.ones((1, 80, 80)), 2), **options)

    def test_cavities_are_noted(self):
        hollow = numpy.pad(ball(9), 3)
        hollow[11:16, 11:16, 11:16] = False
        with self.assertWarnsRegex(UserWarning, "; fill_cavities fills cavities") as caught:
            skeleton = bccskel.skeletonize(hollow)
        self.assertEqual(caught.filename, __file__)
        self.assertEqual(skeleton.certificate["skeleton"]["cavities"], 1)
        with self.assertWarnsRegex(UserWarning, "cavities 1 -> 0"):
            filled = bccskel.skeletonize(hollow, fill_cavities=True)
        self.assertEqual(filled.certificate["skeleton"]["cavities"], 0)

    def test_its_representation_names_it(self):
        self.assertRegex(repr(self.skeleton),
                         r"<Skeleton of mask: 5 nodes, 4 edges, length [\d.]+, topology kept>")
        sampled = bccskel.skeletonize(crossing_bars(), sampling="nearest")
        self.assertRegex(repr(sampled), ", topology of the sampled object kept, sampling may have "
                                        "changed the mask's>$")


if __name__ == "__main__":
    harness.main()
