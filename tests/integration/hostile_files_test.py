"""Broken and hostile files: each has a stated end, in bounded time and memory."""

import json

import harness

GIB = 2
SECONDS = 20

# A file, and how it ends: an exit code with a part of the message, or the topology
# (components, loops, cavities) with a part of the warning where there must be one.
REFUSED = [
    ("empty.off", 3, "empty"),
    ("empty.stl", 3, "empty"),
    ("empty.obj", 3, "no triangles"),
    ("header_only.stl", 3, "no triangles"),
    ("vertices_only.obj", 3,
     "no triangles (3 vertices): points alone enclose nothing; make a surface of them first"),
    ("truncated_binary.stl", 3, "declares 2208 triangles (110484 bytes) but holds 1103"),
    ("count_lies_4e9.stl", 3, "declares 4294967295 triangles"),
    ("truncated.off", 3, "declares 1106 vertices"),
    ("counts_lie.off", 3, "declares 4000000000 vertices"),
    ("count_lies.ply", 3, "declares 2000000000 elements"),
    ("negative_count.ply", 3, "'-5'"),
    ("list_count_huge.ply", 3, "more than follow"),
    ("nan_vertex.obj", 3, "vertex 3 (counted from 0) is (nan, 1, 0)"),
    ("inf_vertex.stl", 3, "is (inf, 1, 0)"),
    ("offset_1e9.stl", 3, "nothing enclosed"),
    ("one_outlier.off", 7, "the limit is"),
    ("one_triangle.off", 3, "not closed"),
    ("flat_closed.off", 3, "nothing enclosed"),
    ("open_half.off", 3, "not closed (96 boundary edges"),
    ("index_out_of_range.off", 3, "'7'"),
    ("index_negative.off", 3, "'-1'"),
    ("index_zero.obj", 3, "'0'"),
    ("index_overflow.obj", 3, "'99999999999999999999'"),
    ("random_bytes.ply", 3, "must begin with 'ply'"),
    ("long_line.obj", 3, "no triangles (1 vertex):"),
    ("real_elephant-with-holes.off", 3, "not closed (1353 boundary edges"),
]
CAVITY = ("1 cavity leaves a closed surface among the curves, and lengths of branches that meet there "
          "include paths over it; --fill-cavities fills cavities before thinning\n")
ACCEPTED = [
    ("huge_1e30.off", (1, 0, 0), None),
    ("tiny_1e-30.off", (1, 0, 0), None),
    ("offset_1e9.off", (1, 0, 0), None),
    ("zero_area.off", (1, 0, 0), "degenerate triangles were dropped"),
    ("overlap_two_spheres.off", (1, 0, 0), "its parts overlap, and the volume is their union"),
    ("duplicate_solid.off", (1, 0, 0), "or parts touch"),
    ("inverted.off", (1, 0, 0), None),
    ("mixed_orientation.off", (1, 0, 0), "filled by parity"),
    ("hollow_sphere.off", (1, 0, 1), CAVITY),
    ("hollow_same_orientation.off", (1, 0, 0), "same orientation: filled"),
    ("matryoshka.off", (2, 0, 1), CAVITY),
    ("two_cubes_one_vertex.off", (1, 0, 0), "or parts touch"),
    ("two_cubes_one_edge.off", (1, 0, 0), "or parts touch"),
    ("valid_relative_crlf_quads.obj", (1, 0, 0), None),
    ("valid_comments_coff.off", (1, 0, 0), None),
    ("valid_solid_header_binary.stl", (1, 0, 0), None),
    ("valid_ascii_upper.stl", (1, 0, 0), None),
    ("valid_big_endian_extra.ply", (1, 0, 0), None),
    ("wrong_extension.stl", (1, 0, 0), None),
    ("real_blobby-shuffled.off", (1, 0, 0), "filled by parity"),
    ("open_one_missing.off", (1, 0, 0), "not closed (3 boundary edges"),
    ("fin_nonmanifold.off", (1, 0, 0), "not closed (2 boundary edges, 1 non-manifold edge"),
    ("real_suzanne_open.obj", (1, 4, 0), "not closed (42 boundary edges"),
]
# Whatever topology the grid gives these; the point is that they end well.
SURVIVED = ["real_beast_nonmanifold.obj.gz", "real_openscad-nonmanifold-crash.obj"]
# Images, in the same way; the topology is that of the mask, too.
IMAGES_REFUSED = [
    ("short_data.nrrd", 3, "declares 262144 bytes of voxels"),
    ("sizes_1e6_cubed.nrrd", 7, "1000000 x 1000000 holds 1000000000000 voxels, the limit is"),
    ("sizes_overflow.nrrd", 7, "axis 0 holds 4294967296 voxels, the limit is 2097151"),
    ("sizes_negative.nrrd", 3, "axis 0 holds -8 voxels"),
    ("sizes_zero.nrrd", 3, "axis 0 holds 0 voxels"),
    ("four_dim.nrrd", 3, "4 axes (3 x 8 x 8 x 8)"),
    ("float_nan.nrrd", 3, "lacks 'endian'"),
    ("gzip_truncated.nrrd", 3, "is cut"),
    ("gzip_bomb.nrrd", 3, "the compressed stream holds more"),
    ("detached_path.nrrd", 3, "names '/etc/passwd'"),
    ("spacing_zero.nrrd", 3, "spacing 0 x 1 x 1"),
    ("pickle_object.npy", 3, "'|O'"),
    ("shape_overflow.npy", 7, "4000000000 voxels, the limit is"),
]
IMAGES_ACCEPTED = [
    ("all_zero.nrrd", (0, 0, 0)),
    ("all_one.nrrd", (1, 0, 0)),
    ("single_voxel.nrrd", (1, 0, 0)),
    ("one_by_one.nrrd", (1, 0, 0)),
    ("anisotropic_1000.nrrd", None),
    ("fortran_order.npy", None),
    ("big_endian_u2.npy", None),
]


@harness.needs_data("hostile")
class HostileFilesTest(harness.TestCase):
    def run_on(self, name, *words):
        return harness.bccskel("skeletonize", harness.DATA / "hostile" / name, "--local",
                               "--points", 20000, "--json", "-o", self.path("out.json"), *words,
                               timeout=SECONDS, preexec_fn=harness.limit_memory(GIB))

    def check_refused(self, done, code, message):
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertIn("bccskel: error: ", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertFalse((self.folder / "out.json").exists())

    def test_broken_files_are_refused_with_the_reason(self):
        for name, code, message in REFUSED:
            with self.subTest(name):
                done = self.run_on(name)
                self.check_refused(done, code, message)
                self.assertEqual(done.stderr.count(name), 1, "the file is named once")

    def test_valid_and_repairable_files_give_their_topology(self):
        for name, topology, warning in ACCEPTED:
            with self.subTest(name):
                done = self.run_on(name)
                self.assertEqual(done.returncode, 0, done.stderr)
                betti = json.loads(done.stdout)["certificate"]["skeleton"]
                self.assertEqual(harness.topology(betti), topology)
                self.assertIn(warning or "", done.stderr)
                self.assertEqual(bool(warning), bool(done.stderr), done.stderr)

    def test_a_cube_whose_lengths_may_not_fit_a_double_is_refused_or_right(self):
        for words in ((), ("--pruning", "none", "--tips", "as-thinned", "--stubble", "none")):
            done = self.run_on("overflow_1e300.off", *words)
            if done.returncode != 0:
                self.check_refused(done, 3, "do not fit a double")
                continue
            with open(self.path("out.json"), encoding="utf-8") as file:
                text = file.read().lower()
            self.assertNotIn("inf", text)
            self.assertNotIn("nan", text)
            (self.folder / "out.json").unlink()

    def test_non_manifold_meshes_end_well(self):
        for name in SURVIVED:
            with self.subTest(name):
                done = self.run_on(name)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(json.loads(done.stdout)["topology_kept"])

    def test_open_meshes_can_be_filled_by_winding_number(self):
        for name in ("open_half.off", "real_elephant-with-holes.off"):
            with self.subTest(name):
                done = self.run_on(name, "--fill", "winding")
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_info_survives_them_all(self):
        for name in [row[0] for row in REFUSED + ACCEPTED] + SURVIVED:
            with self.subTest(name):
                done = harness.bccskel("info", harness.DATA / "hostile" / name, "--json",
                                       timeout=SECONDS, preexec_fn=harness.limit_memory(GIB))
                self.assertIn(done.returncode, (0, 3), done.stderr)
                if done.returncode == 0:
                    json.loads(done.stdout)

    def skeletonize_image(self, name):
        return harness.bccskel("skeletonize", harness.DATA / "hostile" / name, "--local", "--json",
                               "-o", self.path("out.json"), "-o", self.path("out.vtp"),
                               timeout=SECONDS, preexec_fn=harness.limit_memory(GIB))

    def test_broken_images_are_refused_with_the_reason(self):
        for name, code, message in IMAGES_REFUSED:
            with self.subTest(name):
                done = self.skeletonize_image(name)
                self.check_refused(done, code, message)
                self.assertEqual(done.stderr.count(name), 1, "the file is named once")

    def test_valid_images_keep_the_topology_of_their_mask(self):
        for name, topology in IMAGES_ACCEPTED:
            with self.subTest(name):
                done = self.skeletonize_image(name)
                summary = json.loads(done.stdout)
                certificate = summary["certificate"]
                said = summary["image"]["warnings"] + summary["notes"]
                self.assertEqual((done.returncode, done.stderr.count("warning: ")), (0, len(said)))
                self.assertEqual("the object has no points" in said,
                                 certificate["mask"]["components"] == 0)
                self.assertEqual(certificate["mask"], certificate["skeleton"])
                if topology:
                    self.assertEqual(tuple(certificate["mask"].values()), topology)

    def test_every_file_has_a_stated_end(self):
        rows = REFUSED + ACCEPTED + IMAGES_REFUSED + IMAGES_ACCEPTED
        stated = {row[0] for row in rows} | set(SURVIVED) | {"LIST.md", "overflow_1e300.off"}
        present = {p.name for p in (harness.DATA / "hostile").iterdir()}
        self.assertEqual(present, stated)


if __name__ == "__main__":
    harness.main()
