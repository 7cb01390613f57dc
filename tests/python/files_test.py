"""Files that the package writes are those of the command line; files that it reads, too."""

import json
import re
import unittest.mock
import warnings

import bccskel
import harness
import numpy

from shapes import box_mesh, crossing_bars

ENDINGS = (".swc", ".vtp", ".graphml", ".obj", ".json", ".csv", ".glb", ".mrk.json", ".exr", ".bccb",
           ".svg", ".png", ".html")


def without_times(text):
    return re.sub(rb'"timings":\{[^}]*\}', b"", text)


class FilesTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.image = self.path("mask.npy")
        numpy.save(self.image, crossing_bars())

    def bytes(self, name):
        return without_times((self.folder / name).read_bytes())

    def test_every_format_has_the_bytes_of_the_command_line(self):
        words = [word for ending in ENDINGS for word in ("-o", self.path("theirs" + ending))]
        self.succeed("skeletonize", self.image, "--local", "--root", "thickest-end", *words)
        skeleton = bccskel.skeletonize(bccskel.read(self.image), root="thickest-end")
        for ending in ENDINGS:
            with self.subTest(ending):
                if ending in (".swc", ".mrk.json"):  # cannot hold the ring; needs to know the world
                    with self.assertWarns(UserWarning):
                        skeleton.save(self.path("mine" + ending))
                else:
                    skeleton.save(self.folder / ("mine" + ending))
                if ending != ".html":  # the command line shows how the object was peeled
                    self.assertEqual(self.bytes("mine" + ending), self.bytes("theirs" + ending))
        self.assertGreater(len(self.bytes("mine.html")), 100_000)

    def test_unsupported_encodings_are_value_errors(self):
        header = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n"
                  "1 0 1 0 1 0 1 0\n")
        (self.folder / "a.nrrd").write_text(header)
        with self.assertRaisesRegex(ValueError, "ascii"):
            bccskel.read(self.path("a.nrrd"))
        (self.folder / "a.mha").write_text(
            "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
            "BinaryData = False\nElementDataFile = LOCAL\n1 0 1 0 1 0 1 0\n")
        with self.assertRaisesRegex(ValueError, "as text"):
            bccskel.read(self.path("a.mha"))

    def test_a_place_for_the_label_makes_a_file_for_each(self):
        labels = crossing_bars().astype("u2") * 3
        labels[:, :, 25:] *= 100
        numpy.save(self.image, labels)
        endings = (".json", ".swc", ".exr", ".vtp")
        words = [word for ending in endings
                 for word in ("-o", self.path("theirs-{label}/a{label}" + ending))]
        self.succeed("labels", self.image, "--local", "--root", "thickest-node", *words)
        skeletons = bccskel.skeletonize_labels(bccskel.read(self.image), root="thickest-node")
        for ending in endings:
            bccskel.save_labels(self.path("mine-{label}/a{label}" + ending), skeletons)
            for label in (3, 300):
                self.assertEqual(self.bytes(f"mine-{label}/a{label}{ending}"),
                                 self.bytes(f"theirs-{label}/a{label}{ending}"))
        bccskel.save_labels(self.path("none-{label}.swc"), {})
        self.assertEqual(list(self.folder.glob("*none*")), [])
        with self.assertRaisesRegex(ValueError, "holds one label; write {label} where the label's number"):
            bccskel.save_labels(self.path("all.swc"), skeletons)
        for name, title in (("all.svg", "2 labels"), ("one-{label}.svg", "label 300")):
            bccskel.save_labels(self.path(name), skeletons)
            picture = (self.folder / name.format(label=300)).read_text(encoding="utf-8")
            self.assertIn(f">{title}</text>", picture)
        skeletons[3].save(self.path("read.json"))
        read = {3: bccskel.read(self.path("read.json"))}
        for name in ("read.html", "read.json"):
            with self.assertRaisesRegex(ValueError, "results that were read"):
                bccskel.save_labels(self.path(name), read)
        bccskel.save_labels(self.path("read-{label}.png"), read)  # the curves alone
        self.assertTrue((self.folder / "read-3.png").read_bytes().startswith(b"\x89PNG"))
        with self.assertRaises(OSError):
            bccskel.save_labels(self.path("missing/{label}.swc"), skeletons)

    def test_what_an_image_says_of_its_world_is_in_the_files(self):
        mask = crossing_bars().astype("u1")
        with open(self.path("mask.nrrd"), "wb") as file:
            file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: LPS\nencoding: raw\n"
                       b"space units: \"mm\" \"mm\" \"mm\"\n"
                       b"space directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (5,6,7)\n")
            file.write(f"sizes: {mask.shape[2]} {mask.shape[1]} {mask.shape[0]}\n\n".encode())
            file.write(mask.tobytes())
        self.succeed("skeletonize", self.path("mask.nrrd"), "--local", "--swc-step", 0.5,
                     "-o", self.path("theirs.json"), "-o", self.path("theirs.swc"))
        skeleton = bccskel.skeletonize(bccskel.read(self.path("mask.nrrd")))
        self.assertEqual((skeleton.world, skeleton.unit), ("LPS", "mm"))
        skeleton.save(self.path("mine.json"))
        with self.assertWarns(UserWarning):
            skeleton.save(self.path("mine.swc"), swc_step=0.5)
        for ending in (".json", ".swc"):
            self.assertEqual(self.bytes("mine" + ending), self.bytes("theirs" + ending))
        self.assertEqual(json.loads((self.folder / "mine.json").read_text())["world"], "LPS")
        with self.assertRaisesRegex(ValueError, "swc_step -1: must be 0 or more"):
            skeleton.save(self.path("mine.swc"), swc_step=-1)

    def test_a_unit_can_be_stated_of_arrays_images_and_meshes(self):
        mask = crossing_bars()
        image = bccskel.Image(mask, (1, 1, 1), (0, 0, 0), numpy.eye(3), "mm")
        labels = bccskel.skeletonize_labels(mask.astype("u1"), unit="micron")
        for skeleton, unit in ((bccskel.skeletonize(mask, unit="um"), "um"),
                               (bccskel.skeletonize(image), "mm"),
                               (bccskel.skeletonize(image, unit="nm"), "nm"), (labels[1], "um"),
                               (bccskel.skeletonize_mesh(*box_mesh(), points=2000, unit="cm"), "cm")):
            self.assertEqual(skeleton.unit, unit)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            labels[1].save(self.path("stated.precomputed"))
        bccskel.skeletonize(mask, unit="um").save(self.path("stated.json"))
        self.assertEqual(bccskel.read(self.path("stated.json")).unit, "um")
        with self.assertRaisesRegex(ValueError, "^unit parsec: must be a unit of length, such as nm"):
            bccskel.skeletonize(mask, unit="parsec")
        with self.assertRaisesRegex(TypeError, "^unit must be a text such as 'um', got int"):
            bccskel.skeletonize_labels(mask, unit=3)

    def test_a_path_is_not_cut_at_a_nul(self):
        skeleton = bccskel.skeletonize(crossing_bars())
        for act in (skeleton.save, bccskel.read,
                    lambda path: bccskel.save_labels(path, {1: skeleton})):
            with self.assertRaisesRegex(ValueError, "a path must not contain NUL"):
                act(self.path("cut\0.json"))
        self.assertFalse((self.folder / "cut").exists())

    def test_images_are_those_of_the_command_line(self):
        for options in ({}, {"voxel_points": 16}):
            words = [word for name, value in options.items()
                     for word in ("--" + name.replace("_", "-"), value)]
            self.succeed("skeletonize", self.image, "--local", "--curve-image",
                         self.path("curves.nrrd"), "--branch-image", self.path("branches.nrrd"),
                         *words, "-o", self.path("a.obj"))
            mask = numpy.load(self.image)
            skeleton = bccskel.skeletonize(mask, **options)
            turned = bccskel.skeletonize(mask.T, axes="xyz", **options)
            label = bccskel.skeletonize_labels(mask.astype("u2") * 9, **options)[9]
            for name in ("curve", "branch"):
                theirs = bccskel.read(self.path({"curve": "curves.nrrd",
                                                 "branch": "branches.nrrd"}[name])).array
                for one, image in ((skeleton, theirs), (turned, theirs.T), (label, theirs)):
                    numpy.testing.assert_array_equal(getattr(one, name + "_image")(), image)

    def test_what_has_no_voxels_is_not_drawn(self):
        mask = numpy.load(self.image)
        for skeleton in (bccskel.skeletonize_mesh(*box_mesh(), points=1000),
                         bccskel.skeletonize(mask, denoise=1),
                         bccskel.skeletonize(mask, sampling="trilinear")):
            with self.assertRaises(ValueError):
                skeleton.curve_image()
        with self.assertRaisesRegex(ValueError, "cut_loops, .*or a preset other than cad$"):
            bccskel.skeletonize(mask, cut_loops=1e-9).curve_image()

    def test_a_page_shows_in_a_notebook_or_a_browser(self):
        with unittest.mock.patch("webbrowser.open") as browser:
            page = bccskel.skeletonize(numpy.ones((5, 5, 30))).view()
        [[url], _] = browser.call_args
        self.addCleanup(harness.pathlib.Path(url.removeprefix("file://")).unlink)
        self.assertEqual(harness.pathlib.Path(url.removeprefix("file://")).read_text(), page.html)
        self.assertIn("srcdoc=\"&lt;!", page._repr_html_().replace("\n", "")[:200])
        page.save(self.path("page.html"))
        self.assertEqual((self.folder / "page.html").read_text(), page.html)

    def test_where_there_is_no_browser_the_page_is_named(self):
        with unittest.mock.patch("webbrowser.open", return_value=False), \
             self.assertWarnsRegex(UserWarning, "found no browser; the page is /.*html") as told:
            bccskel.skeletonize(numpy.ones((5, 5, 30))).view()
        path = harness.pathlib.Path(str(told.warning).rpartition(" ")[2])
        self.addCleanup(path.unlink)
        self.assertIn("<html", path.read_text())

    def test_an_image_keeps_its_place(self):
        nrrd = (b"NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n"
                b"endian: little\nspace: LPS\nspace directions: (0,2,0) (-3,0,0) (0,0,5)\n"
                b"space origin: (7,8,9)\n\n")
        values = numpy.arange(24, dtype="<i2").reshape(2, 3, 4)
        (self.folder / "a.nrrd").write_bytes(nrrd + values.tobytes())
        image = bccskel.read(self.path("a.nrrd"))
        numpy.testing.assert_array_equal(image.array, values)
        self.assertEqual((image.array.dtype, image.spacing, image.origin, image.world, image.name),
                         (numpy.dtype("i2"), (5, 3, 2), (9, 8, 7), "LPS", "a.nrrd"))
        skeleton = bccskel.skeletonize(image)
        self.succeed("skeletonize", self.path("a.nrrd"), "--local", "-o", self.path("a.json"))
        theirs = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(skeleton.sha256, theirs["sha256"])
        numpy.testing.assert_allclose(skeleton.nodes[:, ::-1],
                                      [node["position"] for node in theirs["nodes"]])

    def test_folders_of_chunks_are_read(self):
        mask = crossing_bars().astype("u1")
        folder = self.folder / "mask.ome.zarr"
        (folder / "0").mkdir(parents=True)
        (folder / ".zattrs").write_text(json.dumps({"multiscales": [{
            "version": "0.4",
            "axes": [{"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"],
            "datasets": [{"path": "0", "coordinateTransformations": [
                {"type": "scale", "scale": [3, 2, 1]}]}]}]}))
        (folder / "0" / ".zarray").write_text(json.dumps({
            "zarr_format": 2, "shape": mask.shape, "chunks": mask.shape, "dtype": "|u1",
            "fill_value": 0, "order": "C", "compressor": None, "filters": None}))
        (folder / "0" / "0.0.0").write_bytes(mask.tobytes())
        image = bccskel.read(folder, level=0)
        self.assertTrue((image.array == mask).all())
        self.assertEqual((image.spacing, image.unit), ((3, 2, 1), "um"))
        with self.assertRaisesRegex(ValueError, "level 1 is not there"):
            bccskel.read(folder, level=1)
        bccskel.skeletonize(image).save(self.folder / "out.precomputed")
        self.assertTrue((self.folder / "out.precomputed" / "1").stat().st_size > 8)

    def test_raw_voxels_are_read(self):
        values = numpy.arange(24, dtype=">u2").reshape(2, 3, 4)
        (self.folder / "a.bin").write_bytes(b"head" + values.tobytes())
        image = bccskel.read(self.path("a.bin"), raw_size=(2, 3, 4), raw_type="u16",
                             raw_order="big", raw_header=4, voxel_size=(3, 2, 1))
        numpy.testing.assert_array_equal(image, values)
        self.assertEqual(image.spacing, (3, 2, 1))

    def test_one_number_is_the_size_of_cubes(self):
        numpy.save(self.path("a.npy"), numpy.ones((2, 3, 4), "u1"))
        for size in (0.5, numpy.float32(0.5)):
            image = bccskel.read(self.path("a.npy"), voxel_size=size)
            self.assertEqual(image.spacing, (0.5, 0.5, 0.5))
        with self.assertRaisesRegex(ValueError, "voxel_size: must be 1e-15 to 1e[+]15, not nan"):
            bccskel.read(self.path("a.npy"), voxel_size=float("nan"))

    def test_a_mesh_gives_the_command_line_s_skeleton(self):
        vertices, faces = box_mesh()
        with open(self.path("box.off"), "w") as file:
            print("OFF", len(vertices), len(faces), 0, file=file)
            for row in vertices.tolist():
                print(*row, file=file)
            for row in faces.tolist():
                print(3, *row, file=file)
        for words, options in (("--points 3000", dict(points=3000)),
                               ("--spacing 0.25 --fill winding",
                                dict(spacing=0.25, fill="winding"))):
            theirs = json.loads(self.succeed("skeletonize", self.path("box.off"), "--local",
                                             "--json", *words.split(), "-o", self.path("b.obj")))
            for mesh in ((vertices, faces), (bccskel.read(self.path("box.off")),)):
                mine = bccskel.skeletonize_mesh(*mesh, **options)
                self.assertEqual(mine.sha256, theirs["sha256"])
                self.assertEqual(mine.axes, "xyz")


if __name__ == "__main__":
    harness.main()
