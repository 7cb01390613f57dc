"""Meshes in files that programs of others wrote give the skeleton of the same mesh in ours."""

import base64
import json
import math
import pathlib
import struct
import unittest

import harness
import numpy

try:
    import nibabel
except ImportError:
    nibabel = None
try:
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkStripper
    from vtkmodules.vtkIOLegacy import vtkDataSetWriter, vtkPolyDataWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
except ImportError:
    vtkPoints = None


def bent_tube(around=12, along=24):
    """(points, triangles) of a closed tube along an arc, outward, in single precision."""
    points, triangles = [], []
    for n in range(along):
        turn = math.pi * n / (along - 1)
        for k in range(around):
            side = 2 * math.pi * k / around
            reach = 10 + 2 * math.cos(side)
            points.append((reach * math.cos(turn), reach * math.sin(turn), 2 * math.sin(side)))
    for n in range(along - 1):
        for k in range(around):
            a, b = n * around + k, n * around + (k + 1) % around
            triangles += [(a, b + around, b), (a, a + around, b + around)]
    for first, turned in ((0, False), ((along - 1) * around, True)):  # the caps
        for k in range(1, around - 1):
            corners = (first, first + k, first + k + 1)
            triangles.append(corners[::-1] if turned else corners)
    return numpy.array(points, numpy.float32), numpy.array(triangles, numpy.int32)


def to_off(points, triangles):
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
    lines += [" ".join(repr(float(x)) for x in point) for point in points]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    return "\n".join(lines) + "\n"


def to_gltf(points, triangles, uri):
    data = points.tobytes() + triangles.astype("<u2").tobytes()
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": triangles.size, "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteLength": points.nbytes},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": 2 * triangles.size}],
        "buffers": [{"byteLength": len(data), **({"uri": uri} if uri else {})}]}
    return document, data


def to_glb(points, triangles):
    document, data = to_gltf(points, triangles, None)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
            + text + struct.pack("<II", len(data), 0x004E4942) + data)


def to_poly_data(points, triangles):
    places, cells = vtkPoints(), vtkCellArray()
    for point in points:
        places.InsertNextPoint(*map(float, point))
    for triangle in triangles:
        cells.InsertNextCell(3, [int(corner) for corner in triangle])
    data = vtkPolyData()
    data.SetPoints(places)
    data.SetPolys(cells)
    return data


class MeshesTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.points, self.triangles = bent_tube()
        (self.folder / "mesh.off").write_text(to_off(self.points, self.triangles))
        self.expected = self.digest("mesh.off")

    def digest(self, name):
        return self.summarize("skeletonize", self.path(name), "--local", "--points", 3000,
                              "-o", self.path("s.json"))["sha256"]

    def expect_same(self, name):
        with self.subTest(name):
            self.assertEqual(self.digest(name), self.expected)

    def test_gltf(self):
        document, data = to_gltf(self.points, self.triangles, "mesh.bin")
        (self.folder / "mesh.bin").write_bytes(data)
        (self.folder / "beside.gltf").write_text(json.dumps(document))
        document["buffers"][0]["uri"] = ("data:application/gltf-buffer;base64,"
                                         + base64.b64encode(data).decode())
        (self.folder / "embedded.gltf").write_text(json.dumps(document))
        (self.folder / "mesh.glb").write_bytes(to_glb(self.points, self.triangles))
        for name in ("beside.gltf", "embedded.gltf", "mesh.glb"):
            self.expect_same(name)

    @unittest.skipIf(vtkPoints is None, "needs python3-vtk9")
    def test_legacy_files_of_vtk(self):
        for layout in (42, 51):
            for kind in ("ASCII", "Binary"):
                writer = vtkPolyDataWriter()
                writer.SetInputData(to_poly_data(self.points, self.triangles))
                writer.SetFileVersion(layout)
                getattr(writer, f"SetFileTypeTo{kind}")()
                name = f"mesh-{layout}-{kind}.vtk"
                writer.SetFileName(self.path(name))
                self.assertEqual(writer.Write(), 1)
                self.expect_same(name)

    @unittest.skipIf(vtkPoints is None, "needs python3-vtk9")
    def test_strips_of_vtk_have_the_same_triangles(self):
        stripper = vtkStripper()
        stripper.SetInputData(to_poly_data(self.points, self.triangles))
        for name, writer in (("strips.vtk", vtkPolyDataWriter()),
                             ("strips.vtp", vtkXMLPolyDataWriter())):
            writer.SetInputConnection(stripper.GetOutputPort())
            writer.SetFileName(self.path(name))
            if name.endswith(".vtk"):
                writer.SetFileTypeToBinary()  # text is rounded
            self.assertEqual(writer.Write(), 1)
            ours, theirs = (json.loads(self.succeed("info", self.path(n), "--json"))["mesh"]
                            for n in ("mesh.off", name))
            self.assertEqual((theirs["triangles"], theirs["consistently_oriented"]),
                             (ours["triangles"], True))
            self.assertAlmostEqual(theirs["volume"], ours["volume"])

    @unittest.skipIf(vtkPoints is None, "needs python3-vtk9")
    def test_xml_files_of_vtk(self):
        for mode in ("Ascii", "Binary", "Appended"):
            for order in ("LittleEndian", "BigEndian"):
                for header in ("UInt32", "UInt64"):
                    for compressor in ("None", "ZLib"):
                        self.expect_same(self.write_vtp(mode, order, header, compressor))
        self.expect_same(self.write_vtp("Appended", "LittleEndian", "UInt32", "ZLib", True))
        self.expect_same(self.write_vtp("Appended", "BigEndian", "UInt64", "None", True))
        for compressor in ("LZ4", "LZMA"):
            name = self.write_vtp("Appended", "LittleEndian", "UInt32", compressor)
            self.fail_with(3, f"compressor 'vtk{compressor}DataCompressor' is not read", "info",
                           self.path(name))

    def write_vtp(self, mode, order, header, compressor, in_base64=False):
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(to_poly_data(self.points, self.triangles))
        for what, value in (("DataMode", mode), ("ByteOrder", order), ("HeaderType", header),
                            ("CompressorType", compressor)):
            getattr(writer, f"Set{what}To{value}")()
        writer.SetEncodeAppendedData(in_base64)
        writer.SetBlockSize(4096)
        name = f"{mode}-{order}-{header}-{compressor}-{in_base64}.vtp"
        writer.SetFileName(self.path(name))
        self.assertEqual(writer.Write(), 1)
        return name

    @unittest.skipIf(vtkPoints is None, "needs python3-vtk9")
    def test_images_of_vtk_are_no_meshes(self):
        image = vtkImageData()
        image.SetDimensions(2, 2, 2)
        writer = vtkDataSetWriter()
        writer.SetInputData(image)
        writer.SetFileName(self.path("image.vtk"))
        self.assertEqual(writer.Write(), 1)
        self.fail_with(3, "found 'STRUCTURED_POINTS'", "info", self.path("image.vtk"))

    @unittest.skipIf(nibabel is None, "needs python3-nibabel")
    def test_gifti(self):
        for encoding in ("ASCII", "B64BIN", "B64GZ"):
            arrays = [nibabel.gifti.GiftiDataArray(values, intent, encoding=f"GIFTI_ENCODING_{encoding}")
                      for values, intent in ((self.points, "NIFTI_INTENT_POINTSET"),
                                             (self.triangles, "NIFTI_INTENT_TRIANGLE"))]
            name = f"lh.{encoding}.surf.gii"
            nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), self.path(name))
            if encoding == "ASCII":  # rounded
                self.assertEqual(self.succeed("info", self.path(name)).split()[1],
                                 str(len(self.points)))
            else:
                self.expect_same(name)

    @unittest.skipIf(nibabel is None, "needs python3-nibabel")
    def test_freesurfer(self):
        for name in ("lh.white", "RH.Pial"):
            nibabel.freesurfer.write_geometry(self.path(name), self.points, self.triangles)
            self.expect_same(name)
        nibabel.freesurfer.write_morph_data(self.path("lh.thickness"), numpy.ones(8, "f4"))
        self.fail_with(3, "values per vertex (as lh.thickness)", "info", self.path("lh.thickness"))

    def test_a_thin_plate_is_whole_and_sampled_on_request(self):
        # Half a lattice unit thick; it leans, so that most lattice points pass it by.
        corners = [(x, y, z + 0.3 * x + 0.4 * y)
                   for z in (0, 0.25) for y in (0, 20) for x in (0, 30)]
        faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
                 (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
        (self.folder / "plate.off").write_text(to_off(corners, faces))
        plate = (self.path("plate.off"), "--local", "--spacing", 1, "--lattice-axes", "world",
                 "-o", self.path("p.json"))
        text = harness.bccskel("skeletonize", *plate).stdout
        self.assertRegex(text, r"thin: +[0-9,]+ points added, so that parts thinner than two")
        self.assertRegex(text, r"object: .*, 1 component, 0 loops, 0 cavities")
        kept = self.summarize("skeletonize", *plate)
        self.assertGreater(kept["added_points"], kept["object_points"] / 2)
        sampled = json.loads(harness.bccskel("skeletonize", *plate, "--thin-parts", "sample",
                                             "--json").stdout)
        self.assertEqual(sampled["added_points"], 0)
        self.assertGreater(sampled["certificate"]["input"]["components"], 100)
        self.fail_with(2, "--lattice-axes are for meshes", "skeletonize", self.generate("ball"),
                       "--local", "--thin-parts", "sample", "-o", self.path("b.json"))

    def test_every_pose_gives_the_same_skeleton(self):
        points = self.points.astype(float)
        points *= 1 + 0.03 * points[:, :1] + 0.05 * points[:, 2:]  # no symmetry is left
        turn, _ = numpy.linalg.qr(numpy.array([[3, 1, -2], [1, 4, 1], [2, -1, 5.0]]))
        turn *= numpy.linalg.det(turn)
        lengths = {}
        for name, posed in (("a", points), ("b", points @ turn.T + (7, -50, 3))):
            (self.folder / f"{name}.off").write_text(to_off(posed, self.triangles))
            for axes in ("shape", "world"):
                result = self.path(f"{name}_{axes}.json")
                self.succeed("skeletonize", self.path(f"{name}.off"), "--local", "--points", 20000,
                             "--lattice-axes", axes, "-o", result)
                edges = json.loads(pathlib.Path(result).read_text())["edges"]
                lengths[name, axes] = sorted(edge["length"] for edge in edges)
                picture = harness.bccskel("render", result, "--object", self.path(f"{name}.off"),
                                          "-o", self.path("p.png"))
                self.assertEqual((picture.returncode, picture.stderr), (0, ""))
        numpy.testing.assert_allclose(lengths["a", "shape"], lengths["b", "shape"], rtol=1e-6)
        voxelize = ("voxelize", self.path("a.off"), "--points", 3000, "-o", self.path("a.exr"))
        self.assertRegex(self.succeed(*voxelize), "\ndirection: +-?0")
        self.assertNotIn("direction", self.succeed(*voxelize, "--lattice-axes", "world"))
        self.assertNotEqual(lengths["a", "world"], lengths["b", "world"])

    def test_an_open_mesh_that_encloses_nothing_is_soon_refused(self):
        # It took minutes, on finer and finer grids.
        mesh = pathlib.Path(self.path("one.off"))
        mesh.write_text("OFF\n3 1 0\n0 0 0\n1 0.1 0\n0.2 1 0.3\n3 0 1 2\n")
        self.fail_with(3, "nothing enclosed", "voxelize", mesh, "--fill", "winding",
                       "--points", 300, "-o", self.path("n.bccb"), timeout=60)

    def test_results_are_told_from_meshes(self):
        vtp, glb = self.path("s.vtp"), self.path("s.glb")
        self.succeed("skeletonize", self.path("mesh.off"), "--local", "--points", 3000, "-o", vtp,
                     "-o", glb)
        self.fail_with(3, "skeletons that bccskel writes are lines", "info", vtp)
        self.fail_with(3, "skeletons that bccskel writes are lines", "skeletonize", vtp, "--local",
                       "-o", self.path("t.swc"))
        mesh = json.loads(self.succeed("info", glb, "--json"))["mesh"]
        self.assertTrue(mesh["watertight"])
        pathlib.Path(vtp).write_bytes(to_glb(self.points, self.triangles))
        self.expect_same("s.vtp")  # the content decides


if __name__ == "__main__":
    harness.main()
