"""Segmented images: from the file to a skeleton that keeps what the mask has, at its place."""

import gzip
import json
import os
import struct
import subprocess
import xml.etree.ElementTree
import zlib

import harness
import numpy

# A file, what is foreground, its voxels and their (components, loops, cavities), as other programs
# counted them.
VOLUMES = [
    ("airway_p4_chopped.nrrd", (), 485117, (1, 2, 0)),
    ("neuron_28648864.nrrd", (), 335259, (1, 1, 1)),
    ("neuron_28018323.nrrd", (), 384708, (4, 4, 0)),
    ("neuron_28794499.nrrd", (), 1446575, (3, 6, 5)),
    ("Al.100.vol", (), 70413, (1, 2, 0)),
    ("cat10b.vol", (), 8043, (1, 0, 0)),
    ("lobster.vol", ("--threshold", 40), 269432, (46, 547, 222)),
    ("lobsterCroped2.nii.gz", ("--range", "40,"), 50899, (3, 102, 50)),
    ("liver.inr.gz", ("--label", 127), 314086, (1, 0, 33)),
    ("poon2015_BBB_noLeakage_manualLabel_v2.tif", (), 242943, (153, 224, 0)),
    ("santos2015_lowContrastVessels_labelsMarc.tif", (), 458204, (11, 32, 0)),
    ("100_fiberform.tif", ("--threshold", 90), 167140, (10, 6, 16)),
    ("aorta-final-levelset.mha", ("--below", 0), 11590, (1, 0, 0)),
]


def ring(size=(9, 8, 7)):
    """A mask with a loop, index (z, y, x)."""
    mask = numpy.zeros(size[::-1], "u1")
    mask[3, 1:7, 1:8] = 5
    mask[3, 2:6, 3:6] = 0
    return mask


def png(rows):
    """A picture of gray levels of 8 bits."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    size = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], 8, 0, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")


class ImagesTest(harness.TestCase):
    def skeletonize(self, source, *words):
        """The summary of a skeleton made here."""
        return self.summarize("skeletonize", source, "--local", "-o", self.path("s.vtp"), *words)

    def write_ring(self):
        header = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nspace: LPS\n"
                  "space directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (100,200,300)\n"
                  "encoding: gzip\n\n")
        return self.write("ring.nrrd", header.encode() + gzip.compress(ring().tobytes()))

    @harness.needs_data("volume")
    def test_real_volumes_keep_their_topology_through_mask_lattice_and_skeleton(self):
        for name, rule, voxels, topology in VOLUMES:
            with self.subTest(name):
                summary = self.skeletonize(harness.DATA / "volume" / name, *rule)
                self.assertEqual(summary["image"]["voxels"], voxels)
                for stage in ("mask", "input", "skeleton"):
                    found = harness.topology(summary["certificate"][stage])
                    self.assertEqual(found, topology, stage)
                self.assertEqual(summary["certificate"]["simple_points_left"], 0)
                cavities = [note for note in summary["notes"] if "--fill-cavities" in note]
                self.assertEqual(len(cavities), min(topology[2], 1), summary["notes"])

    def test_gray_levels_and_level_sets_taken_for_masks_are_warned_of(self):
        grid = numpy.mgrid[:24, :24, :24] - 12.0
        distance = numpy.sqrt((grid ** 2).sum(0)) - 8.1
        gray = numpy.random.default_rng(3).normal(80 - 60 * numpy.sign(distance), 5)
        for name, image, choice in (("gray", gray.astype("u1"), "--threshold"),
                                    ("band", distance.clip(-2, 2), "--below")):
            numpy.save(self.path(name + ".npy"), image)
            words = ("skeletonize", self.path(name + ".npy"), "--local", "-o", self.path("s.swc"))
            done = harness.bccskel(*words, "--json")
            warning, = json.loads(done.stdout)["image"]["warnings"]
            self.assertIn(f"and all but 0 are taken for the object; {choice} ", warning)
            self.assertIn(f"bccskel: warning: {self.path(name + '.npy')}: {warning}\n", done.stderr)
            chosen = self.summarize(*words, choice, warning.split(choice)[1].split()[0])
            self.assertEqual(chosen["image"]["warnings"], [])
            self.assertEqual(chosen["image"]["voxels"], (distance < 0).sum())

    def test_the_skeleton_lies_in_the_world_of_the_image(self):
        summary = self.skeletonize(self.write_ring())
        self.assertEqual(summary["certificate"]["mask"],
                         {"components": 1, "loops": 1, "cavities": 0})
        text = xml.etree.ElementTree.parse(self.path("s.vtp")).find(".//Points/DataArray").text
        points = numpy.array(text.split(), float).reshape(-1, 3)
        # Voxel (x, y, z) lies at (100 - 3 y, 200 + 2 x, 300 + 4 z); half a voxel around each.
        self.assertTrue((points >= [100 - 3 * 6.5, 200 + 2 * 0.5, 300 + 4 * 2.5]).all(), points)
        self.assertTrue((points <= [100 - 3 * 0.5, 200 + 2 * 7.5, 300 + 4 * 3.5]).all(), points)
        self.assertLess(abs(points[:, 2].mean() - 312), 1)

    def test_the_same_mask_gives_the_same_skeleton_from_every_format(self):
        mask = ring()
        numpy.save(self.path("c.npy"), mask)
        numpy.save(self.path("f.npy"), numpy.asfortranarray(mask.astype(">i4")))
        numpy.save(self.path("h.npy"), mask.astype("f2"))
        raw = self.write("mask.bin", b"head" + mask.astype(">u2").tobytes())
        packed = self.write("mask.raw.gz", gzip.compress(mask.tobytes()))
        layout = ("--raw-size", "9,8,7")
        (self.folder / "slices").mkdir()
        for z, rows in enumerate(mask, 8):
            self.write(f"slices/z{z}.png", png(rows))
        numpy.savez(self.path("named.npz"), other=mask[0], mask=mask)
        numpy.savez_compressed(self.path("only.npz"), mask)
        runs = [self.skeletonize(self.path("c.npy")), self.skeletonize(self.path("f.npy")),
                self.skeletonize(self.path("h.npy")),
                self.skeletonize(raw, *layout, "--raw-type", "u16", "--raw-order", "big",
                                 "--raw-header", 4),
                self.skeletonize(packed, *layout), self.skeletonize(self.path("slices")),
                self.skeletonize(self.path("named.npz"), "--array", "mask"),
                self.skeletonize(self.path("only.npz"))]
        self.assertEqual({run["sha256"] for run in runs}, {runs[0]["sha256"]})
        placed = self.skeletonize(packed, *layout, "--voxel-size", "3,2,0.5")
        self.assertEqual(placed["image"]["spacing"], [3, 2, 0.5])

    def test_folders_of_chunks_give_the_same_skeleton_as_a_file(self):
        mask = ring()
        numpy.save(self.path("mask.npy"), mask)
        zarr, volume = self.folder / "mask.ome.zarr", self.folder / "volume"
        (zarr / "0").mkdir(parents=True)
        (zarr / ".zattrs").write_text(json.dumps({"multiscales": [{
            "version": "0.4", "axes": [{"name": n, "type": "space"} for n in "zyx"],
            "datasets": [{"path": "0"}]}]}))
        (zarr / "0" / ".zarray").write_text(json.dumps({
            "zarr_format": 2, "shape": mask.shape, "chunks": (4, 8, 9), "dtype": "|u1",
            "fill_value": 0, "order": "C", "compressor": {"id": "gzip"}, "filters": None}))
        (volume / "full").mkdir(parents=True)
        (volume / "info").write_text(json.dumps({
            "@type": "neuroglancer_multiscale_volume", "type": "segmentation",
            "data_type": "uint8", "num_channels": 1, "scales": [{
                "key": "full", "size": mask.shape[::-1], "resolution": [1, 1, 1],
                "chunk_sizes": [[9, 8, 4]], "encoding": "raw"}]}))
        for n, slab in enumerate((mask[:4], mask[4:])):
            padded = numpy.zeros((4, 8, 9), "u1")
            padded[:len(slab)] = slab
            (zarr / "0" / f"{n}.0.0").write_bytes(gzip.compress(padded.tobytes()))
            (volume / "full" / f"0-9_0-8_{4 * n}-{4 * n + len(slab)}").write_bytes(slab.tobytes())
        one, other = self.skeletonize(self.path("mask.npy")), self.skeletonize(str(zarr) + "/")
        self.assertEqual(other["image"]["format"], "OME-Zarr")
        self.assertEqual(one["sha256"], other["sha256"])
        self.assertEqual(one["certificate"], self.skeletonize(volume)["certificate"])
        values = json.loads(self.succeed("info", volume, "--json"))["image"]["values"]
        self.assertEqual(values["labels"], [{"label": 5, "voxels": int((mask == 5).sum())}])
        self.fail_with(3, "level 1 is not there", "info", zarr, "--level", 1)
        self.fail_with(2, "--channel and --time apply only to TIFF and OME-Zarr", "info", volume,
                       "--channel", 0)
        self.fail_with(2, "--level applies only to OME-Zarr and precomputed folders", "info",
                       self.path("mask.npy"), "--level", 0)

    def test_several_labels_taken_for_one_object_are_warned_of(self):
        labels = numpy.zeros((9, 9, 12), "u1")
        labels[3:6, 3:6, 2:6] = 2
        labels[3:6, 3:6, 6:10] = 3
        numpy.save(self.path("labels.npy"), labels)
        warning, = self.skeletonize(self.path("labels.npy"))["image"]["warnings"]
        self.assertEqual(warning, "several labels are taken for one object; --label selects some, "
                                  "and the command labels takes each by itself")
        for rule in (("--label", "2,3"), ("--threshold", 1), ("--range", "2,3")):
            self.assertEqual(self.skeletonize(self.path("labels.npy"), *rule)["image"]["warnings"], [])

    def test_one_slice_is_drawn_as_programs_show_the_image(self):
        mask = numpy.zeros((60, 90), "u1")
        for n in range(40):
            mask[8 + n // 2:14 + n // 2, 10 + n:14 + n] = 255  # down to the right
        picture = self.write("mask.png", png(mask))
        self.skeletonize(picture, "-o", self.path("s.svg"), "-o", self.path("s.json"))
        panel = xml.etree.ElementTree.parse(self.path("s.svg")).getroot().find("{*}svg")
        ends = sorted((float(dot.get("cx")), float(dot.get("cy")))
                      for dot in panel.findall(".//{*}circle"))
        self.assertEqual(len(ends), 2)
        (x, y), (x_end, y_end) = ends
        self.assertAlmostEqual((y_end - y) / (x_end - x), 0.5, delta=0.1)
        self.succeed("render", self.path("s.json"), "--object", picture, "-o", self.path("s.png"))
        straight = (self.folder / "s.png").read_bytes()
        self.succeed("render", self.path("s.json"), "--object", picture, "--turn", 0, "--climb", 0,
                     "-o", self.path("s.png"))
        self.assertEqual((self.folder / "s.png").read_bytes(), straight)

    def test_rules_choose_the_object(self):
        ring_file = self.write_ring()
        for rule, loops in ((("--label", "4,5"), 1), (("--label", 4, "--label", 5), 1),
                            (("--range", "5,5"), 1), (("--range", ",-1", "--invert"), 0),
                            (("--threshold", 4.5), 1), (("--below", 1, "--invert"), 1)):
            with self.subTest(rule):
                summary = self.skeletonize(ring_file, *rule)
                self.assertEqual(summary["certificate"]["mask"]["loops"], loops)

    def test_a_label_that_no_voxel_has_is_an_error_that_names_those_there(self):
        ring_file = self.write_ring()
        for command in (("info",), ("skeletonize", "--local", "-o", self.path("s.swc"))):
            self.fail_with(3, "ring.nrrd: no voxel has the label 7 or 9; the image has 1 label: 5",
                           *command, ring_file, "--label", "9,7")
        numpy.save(self.path("many.npy"), numpy.arange(27, dtype="u2").reshape(3, 3, 3))
        self.fail_with(3, "the image has 26 labels: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, ...",
                       "info", self.path("many.npy"), "--label", 99)

    def test_an_image_without_object_or_without_background_is_explained(self):
        numpy.save(self.path("a.npy"), ring())
        numpy.save(self.path("zero.npy"), numpy.zeros((3, 3, 3), "u1"))
        numpy.save(self.path("nan.npy"), numpy.full((3, 3, 3), numpy.nan, "f4"))
        numpy.save(self.path("full.npy"), numpy.ones((3, 3, 3), "i2"))
        for name, rule, warning in (
                ("a", ("--threshold", 9), "--threshold 9 selects no voxel; values range from 0 to 5"),
                ("a", ("--below", 0), "--below 0 selects no voxel; values range from 0 to 5"),
                ("a", ("--range", "6,"), "--range 6, selects no voxel; values range from 0 to 5"),
                ("full", ("--invert",), "--invert selects no voxel; values range from 1 to 1"),
                ("zero", (), "no voxel belongs to the object: all are 0, the background"),
                ("nan", ("--invert",), "no voxel belongs to the object: all are NaN")):
            with self.subTest(warning):
                summary = self.skeletonize(self.path(name + ".npy"), *rule)
                self.assertEqual((summary["image"]["warnings"], summary["notes"]),
                                 ([warning], ["the object has no points"]))
        for name, rule, advice in (
                ("full", (), ", whose voxels seem to have one value: check the image"),
                ("full", ("--label", 1), ""),
                ("a", ("--threshold", 0), "; --threshold or --below selects a part of it")):
            warning, = self.skeletonize(self.path(name + ".npy"), *rule)["image"]["warnings"]
            self.assertEqual(warning, "the object fills the whole image" + advice)

    def test_gzip_around_compressed_voxels_is_undone(self):
        head = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nencoding: gzip\n\n").encode()
        once = self.write("ring.nrrd", head + gzip.compress(ring().tobytes()))
        twice = self.write("ring.nrrd.gz", gzip.compress((self.folder / "ring.nrrd").read_bytes()))
        self.assertEqual(self.skeletonize(twice)["sha256"], self.skeletonize(once)["sha256"])

    def test_raw_voxels_without_their_size_name_the_options(self):
        raw = self.write("z.raw", ring().tobytes())
        self.fail_with(3, "raw voxels need --raw-size and --raw-type", "info", raw)
        self.fail_with(3, "--raw-size, --raw-type and --raw-header make 1000 bytes, the file holds 504",
                       "info", raw, "--raw-size", "10,10,10")

    def test_one_voxel_is_in_the_singular(self):
        one = numpy.zeros((3, 3, 3), "u1")
        one[1, 1, 1] = 1
        numpy.save(self.path("one.npy"), one)
        self.assertIn("foreground:  1 voxel\n", self.succeed("info", self.path("one.npy")))
        self.assertIn(" uint8, 1 voxel\n", self.succeed("skeletonize", self.path("one.npy"),
                                                        "--local", "-o", self.path("a.swc")))

    def test_voxels_that_are_no_numbers_are_counted_in_a_warning(self):
        image = ring().astype("f4")
        image[0, 0, :2] = numpy.nan
        numpy.save(self.path("a.npy"), image)
        warning = "2 voxels are NaN, which counts as background"
        self.assertEqual(self.skeletonize(self.path("a.npy"))["image"]["warnings"], [warning])
        done = harness.bccskel("labels", self.path("a.npy"), "--local", "-o", self.path("a.csv"))
        self.assertEqual((done.returncode, done.stderr),
                         (0, f"bccskel: warning: {self.path('a.npy')}: {warning}\n"))

    def test_adjacency_decides_whether_voxels_at_a_corner_touch(self):
        pair = numpy.zeros((2, 2, 2), "u1")
        pair[0, 0, 0] = pair[1, 1, 1] = 1
        numpy.save(self.path("pair.npy"), pair)
        for adjacency, components in (("26,6", 1), ("6,26", 2)):
            summary = self.skeletonize(self.path("pair.npy"), "--adjacency", adjacency)
            self.assertEqual(summary["certificate"]["skeleton"]["components"], components)

    def test_a_sampling_says_what_it_changed(self):
        line = numpy.zeros((5, 5, 21), "u1")
        line[2, 2, ::2] = 1
        numpy.save(self.path("line.npy"), line)
        done = harness.bccskel("skeletonize", self.path("line.npy"), "--local", "--sampling",
                               "trilinear", "--density", 0.5, "-o", self.path("s.swc"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("sampling changed the topology: components 11 -> ", done.stderr)
        self.assertIn("sampling changed components 11 -> ", done.stdout)
        summary = self.skeletonize(self.path("line.npy"), "--sampling", "nearest")
        self.assertTrue(summary["certificate"]["sampled"])

    def test_the_object_of_a_sampling_asks_for_it(self):
        numpy.save(self.path("a.npy"), ring())
        sampling = ("--sampling", "nearest", "--density", 1)
        harness.bccskel("skeletonize", self.path("a.npy"), "--local", *sampling, "-o",
                        self.path("s.json"))
        view = ("view", self.path("s.json"), "--object", self.path("a.npy"), "-o",
                self.path("v.html"))
        self.assertRegex(harness.bccskel(*view).stderr,
                         "of a sampling: add --sampling and --density as they were\n")
        done = harness.bccskel(*view, *sampling)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("was made from", done.stderr)

    def test_voxels_have_as_many_points_as_asked_for(self):
        numpy.save(self.path("cube.npy"), numpy.ones((10, 10, 10), "u1"))
        for points, count in (("2", 10**3 + 11**3), ("16", 20**3 + 21**3)):
            summary = self.skeletonize(self.path("cube.npy"), "--voxel-points", points)
            self.assertEqual(summary["object_points"], count)
            self.assertTrue(summary["topology_kept"])
            self.assertNotIn("sampled", summary["certificate"])

    def test_voxelize_submit_and_view_take_what_comes_from_an_image(self):
        ring_file = self.write_ring()
        text = self.succeed("voxelize", ring_file, "-o", self.path("v.bccb"))
        self.assertIn("NRRD, 9 x 8 x 7 uint8, 30 voxels", text)
        with harness.Server(self.folder) as server:
            place = ("--server", server.address, "--json", "-o", self.path("s.json"))
            sent = json.loads(self.succeed("submit", self.path("v.bccb"), *place))
            direct = json.loads(self.succeed("skeletonize", ring_file, *place))
        # A volume is no mask any more: only its radii and the margin of pruning are others.
        for key in ("object_points", "skeleton_points", "nodes", "edges"):
            self.assertEqual(sent[key], direct[key])
        self.assertEqual(direct["certificate"]["mask"], direct["certificate"]["skeleton"])
        self.succeed("view", self.path("s.json"), "--object", ring_file, "-o", self.path("v.html"))

    def test_images_show_the_branch_of_every_voxel_and_the_voxels_of_the_curves(self):
        ring_file = self.write_ring()
        summary = self.skeletonize(ring_file, "--branch-image", self.path("b.nrrd"),
                                   "--curve-image", self.path("c.nrrd"))
        branches, curves = (self.read_nrrd(name) for name in ("b.nrrd", "c.nrrd"))
        inside = ring() > 0
        self.assertTrue(((branches > 0) == inside).all())
        self.assertTrue((inside[curves > 0]).all())
        self.assertGreater((curves > 0).sum(), 10)
        self.assertLess((curves > 0).sum(), inside.sum())
        self.assertTrue((branches[curves > 0] == curves[curves > 0]).all())
        self.assertLessEqual(branches.max(), summary["edges"])
        header = (self.folder / "b.nrrd").read_bytes().split(b"\n\n")[0].decode()
        self.assertIn("space origin: (100,200,300)", header)
        self.assertIn("space: left-posterior-superior", header)

    def test_an_image_of_nothing_is_written_and_a_failed_one_replaces_nothing(self):
        empty = self.path("empty.npy")
        numpy.save(empty, numpy.zeros((7, 8, 9), "u1"))
        self.skeletonize(empty, "--branch-image", self.path("b.nrrd"), "--curve-image",
                         self.path("c.nrrd"))
        self.assertEqual(self.read_nrrd("b.nrrd").max() + self.read_nrrd("c.nrrd").max(), 0)
        before = (self.folder / "c.nrrd").read_bytes()
        nowhere = self.path("s.swc")
        os.symlink("/dev/null", nowhere)
        done = subprocess.run(
            ["sh", "-c", 'trap "" XFSZ; ulimit -f 0; exec "$@"', "sh", harness.CLIENT, "skeletonize",
             self.write_ring(), "--local", "-o", nowhere, "--curve-image", self.path("c.nrrd")],
            capture_output=True, text=True)
        self.assertEqual(done.returncode, 8, done.stderr)
        self.assertIn("c.nrrd: File too large", done.stderr)
        self.assertEqual((self.folder / "c.nrrd").read_bytes(), before)

    def read_nrrd(self, name):
        """Index (z, y, x)."""
        header, data = (self.folder / name).read_bytes().split(b"\n\n", 1)
        self.assertIn(b"sizes: 9 8 7", header)
        return numpy.frombuffer(gzip.decompress(data), "<u4").reshape(7, 8, 9)

    def test_the_readme_names_every_key_of_an_image(self):
        readme = (harness.SOURCES / "client/README.md").read_text()
        info = json.loads(self.succeed("info", self.write_ring(), "--json"))
        for key in [*info, *info["image"]]:
            self.assertIn(f"`{key}`", readme)

    def test_options_of_images_are_for_images(self):
        wrong = [("are for images", "a.off", "--label", 1),
                 ("are for images", "a.off", "--branch-image", "b.nrrd"),
                 ("does not end in .nrrd", "a.nii", "--curve-image", "b.tif"),
                 ("are for meshes", "a.nii", "--points", 9),
                 ("--label and --below exclude each other", "a.nii", "--label", 1, "--below", 0),
                 ("holds no number", "a.nii", "--range", "3,2"),
                 ("requires --raw-size", "a.nii", "--raw-type", "u8"),
                 ("not a voxel type", "a.nii", "--raw-size", "1,1,1", "--raw-type", "u12")]
        for message, *words in wrong:
            with self.subTest(message):
                self.fail_with(2, message, "skeletonize", *words, "--local", "-o",
                               self.path("s.swc"))


if __name__ == "__main__":
    harness.main()
