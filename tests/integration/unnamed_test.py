"""Files whose names do not say what they hold."""

import os
import shutil
import subprocess

import harness
import numpy

RING = numpy.zeros((7, 8, 9), "u1")
RING[3, 1:7, 1:8] = 1
RING[3, 2:6, 3:6] = 0
NRRD = (b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nencoding: raw\nspacings: 1 1 1\n\n"
        + RING.tobytes())
SAVE_IT = "cannot be read twice; save it to a file first"


class UnnamedTest(harness.TestCase):
    def loops(self, path):
        return self.summarize("skeletonize", path, "--local", "-o",
                              self.path("s.vtp"))["certificate"]["skeleton"]["loops"]

    def test_images_are_read_by_their_content(self):
        numpy.save(self.path("ring.npy"), RING)
        nifti = bytearray(352)
        nifti[:4] = (348).to_bytes(4, "little")
        for n, value in enumerate((3, 9, 8, 7, 1, 1, 1, 1)):
            nifti[40 + 2 * n:42 + 2 * n] = value.to_bytes(2, "little")
        nifti[70], nifti[72], nifti[344:347] = 2, 8, b"n+1"
        nifti[76:92] = numpy.ones(4, "<f4").tobytes()
        nifti[108:112] = numpy.float32(352).tobytes()
        for content in (NRRD, (self.folder / "ring.npy").read_bytes(), bytes(nifti) + RING.tobytes()):
            for name in ("ring", "ring.dat", "ring.label"):
                self.assertEqual(self.loops(self.write(name, content)), 1, content[:8])
        self.assertIn("NRRD", self.succeed("info", self.write("ring", NRRD)))

    def test_meshes_are_read_by_their_content(self):
        for ending in ("stl", "ply", "off", "vtk"):
            box = self.write(f"box.{ending}", mesh(ending))
            shutil.move(box, self.path("box"))
            self.assertIn("watertight", self.succeed("info", self.path("box")), ending)

    def test_what_is_not_recognized_is_an_error_with_a_remedy(self):
        done = self.fail_with(3, "format not supported", "info", self.write("x", b"12345678" * 9))
        self.assertIn("save another image as NIfTI or NRRD, which keep its place, or as TIFF, PNG or "
                      ".npy", done.stderr)

    def test_results_are_no_input(self):
        for ending in ("json", "swc", "html"):
            self.fail_with(3, "bccskel view shows a result in .json", "skeletonize",
                           self.write(f"s.{ending}", b"{}"), "-o", self.path("t.swc"))

    def test_standard_input_is_read_if_it_is_a_file(self):
        with open(self.write("ring", NRRD), "rb") as file:
            done = harness.bccskel("info", "/dev/stdin", stdin=file)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("9 x 8 x 7", done.stdout)

    def test_pipes_are_refused_with_a_remedy(self):
        for words in (("info",), ("skeletonize", "-o", self.path("a.swc")),
                      ("labels", "-o", self.path("a.csv"))):
            done = subprocess.run([harness.CLIENT, words[0], "/dev/stdin", *words[1:]], input=NRRD,
                                  capture_output=True, timeout=60)
            self.assertIn(f"/dev/stdin: is a pipe or a device, which {SAVE_IT}".encode(),
                          done.stderr)
            self.assertEqual(done.returncode, 3, words)
        os.mkfifo(self.path("pipe.nrrd"))
        self.fail_with(3, SAVE_IT, "info", self.path("pipe.nrrd"))


def mesh(ending):
    corners = [(x, y, z) for x in (0, 3) for y in (0, 2) for z in (0, 1)]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
             (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    lines = "".join("%d %d %d\n" % corner for corner in corners)
    triangles = "".join("3 %d %d %d\n" % face for face in faces)
    if ending == "off":
        return f"OFF\n8 12 0\n{lines}{triangles}".encode()
    if ending == "ply":
        return ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
                "property float z\nelement face 12\nproperty list uchar int vertex_indices\n"
                f"end_header\n{lines}{triangles}").encode()
    if ending == "vtk":
        return ("# vtk DataFile Version 3.0\nbox\nASCII\nDATASET POLYDATA\nPOINTS 8 float\n"
                f"{lines}POLYGONS 12 48\n{triangles}").encode()
    places = numpy.array(corners, "<f4")
    return bytes(80) + (12).to_bytes(4, "little") + b"".join(
        bytes(12) + places[list(face)].tobytes() + bytes(2) for face in faces)


if __name__ == "__main__":
    harness.main()
