"""The scripts of client/examples/fields on data of others: in the shell and in Python they give the same
files, which programs of others read."""

import json
import os
import struct
import subprocess
import sys

import harness
import pandas

FIELDS = harness.SOURCES / "client" / "examples" / "fields"


@harness.needs_data("volume")
class FieldsTest(harness.TestCase):
    def run_scripts(self, field, *words):
        """Both in folders of their own; their output."""
        texts = {}
        for program, ending in ((("sh",), "sh"), ((sys.executable, "-B"), "py")):
            folder = self.folder / ending
            folder.mkdir()
            path = os.path.dirname(harness.CLIENT) + os.pathsep + os.environ["PATH"]
            done = subprocess.run([*program, FIELDS / f"{field}.{ending}", *map(str, words), folder],
                                  capture_output=True, text=True, timeout=300,
                                  env=dict(os.environ, PATH=path))
            self.assertEqual(done.returncode, 0, done.stderr)
            texts[ending] = done.stdout
        return texts

    def same_file(self, name):
        shell, python = ((self.folder / kind / name).read_bytes() for kind in ("sh", "py"))
        self.assertEqual(shell, python, name)
        return shell

    def test_neuroscience(self):
        texts = self.run_scripts("neuroscience", harness.DATA / "volume" / "neuron_28648864.nrrd")
        rows = [line.split() for line in self.same_file("neuron.swc").decode().splitlines()
                if not line.startswith("#")]
        root = [row for row in rows if row[6] == "-1"]
        self.assertEqual(len(root), 1)
        node_radii = [float(row[5]) for row in rows if row[1] in "156"]
        self.assertEqual(root[0][1], "1")
        self.assertEqual(float(root[0][5]), max(node_radii))
        table = pandas.read_csv(self.folder / "sh" / "neuron.csv")
        self.assertIn(f"{len(table)} edges", texts["sh"])
        self.assertIn("strahler", texts["py"])
        self.assertIn("<html", (self.folder / "sh" / "neuron.html").read_text())

    def test_medicine(self):
        self.run_scripts("medicine", harness.DATA / "volume" / "airway_p4_chopped.nrrd")
        markups = json.loads(self.same_file("airway.mrk.json"))["markups"]
        table = pandas.read_csv(self.folder / "sh" / "airway.csv")
        self.assertEqual(len(markups), len(table))
        self.assertEqual({curve["coordinateSystem"] for curve in markups}, {"RAS"})
        self.assertGreater(table["strahler"].max(), 3)
        self.assertTrue((self.folder / "sh" / "airway.png").read_bytes().startswith(b"\x89PNG"))

    def test_materials(self):
        texts = self.run_scripts("materials", harness.DATA / "volume" / "100_fiberform.tif", 90)
        self.same_file("pores.csv")
        table = pandas.read_csv(self.folder / "py" / "pores.csv")
        self.assertIn(f"{len(table)} edges", texts["sh"])
        self.assertTrue((table["min_radius"] <= table["mean_radius"]).all())

    def test_graphics(self):
        texts = self.run_scripts("graphics", harness.DATA / "mesh" / "spot.obj")
        glb = self.same_file("bones.glb")
        magic, version, size = struct.unpack("<4sII", glb[:12])
        self.assertEqual((magic, version, size), (b"glTF", 2, len(glb)))
        self.assertIn(f"{texts['py'].count('bone from')} edges", texts["sh"])


if __name__ == "__main__":
    harness.main()
