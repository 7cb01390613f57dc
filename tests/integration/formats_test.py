"""Every output format, read by a program that we did not write."""

import base64
import html.parser
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib
import xml.etree.ElementTree

import harness
import numpy

try:
    import networkx
except ImportError:
    networkx = None
try:
    import pandas
except ImportError:
    pandas = None
try:
    from vtkmodules.vtkCommonDataModel import vtkBoundingBox
    from vtkmodules.vtkIOGeometry import vtkGLTFReader
except ImportError:
    vtkGLTFReader = None
try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    vtkXMLPolyDataReader = None

SHAPES = ("ball", "torus", "tree", "knot", "hollow-ball")
ENDINGS = ("json", "swc", "vtp", "graphml", "obj", "csv", "mrk.json", "glb", "svg", "html", "exr")


def read_precomputed(folder, segment):
    """(vertices, edges, radii) of Neuroglancer's skeletons, in nanometers."""
    info = json.loads((pathlib.Path(folder) / "info").read_text())
    assert info["@type"] == "neuroglancer_skeletons" and "sharding" not in info
    assert info["transform"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
    assert info["vertex_attributes"] == [
        {"id": "radius", "data_type": "float32", "num_components": 1}]
    data = (pathlib.Path(folder) / str(segment)).read_bytes()
    count, lines = struct.unpack_from("<II", data)
    numbers = struct.unpack_from(f"<{3 * count}f{2 * lines}I{count}f", data, 8)
    assert len(data) == 8 + 4 * len(numbers)
    ends = numbers[3 * count:3 * count + 2 * lines]
    return ([numbers[3 * n:3 * n + 3] for n in range(count)],
            list(zip(ends[::2], ends[1::2])), numbers[3 * count + 2 * lines:])


def pieces_of(count, edges):
    """How many components a graph has."""
    above = list(range(count))

    def top(n):
        while above[n] != n:
            n = above[n]
        return n

    for source, target in edges:
        above[top(source)] = top(target)
    return sum(above[n] == n for n in range(count))


class FormatsTest(harness.TestCase):
    @classmethod
    def setUpClass(cls):
        """Makes s.* of each shape in a folder of its own; pictures cost time, so once for all."""
        cls.folders = pathlib.Path(tempfile.mkdtemp(prefix="bccskel-"))
        cls.addClassCleanup(shutil.rmtree, cls.folders)
        cls.summaries = {}
        for shape in SHAPES:
            folder = cls.folders / shape
            folder.mkdir()
            harness.bccskel("generate", shape, "--points", 10000, "-o", folder / "v.bccb")
            outputs = harness.outputs(folder / f"s.{e}" for e in ENDINGS)
            done = harness.bccskel("skeletonize", folder / "v.bccb", "--local", "--json", *outputs)
            cls.summaries[shape] = json.loads(done.stdout)

    def each_skeleton(self):
        """Summary and document of one shape after the other; path() leads to its files."""
        for shape, summary in self.summaries.items():
            self.folder = self.folders / shape
            with self.subTest(shape=shape):
                yield summary, self.read_json("s.json")

    def test_json_agrees_with_the_summary_and_with_itself(self):
        for summary, document in self.each_skeleton():
            self.assertEqual(document["sha256"], summary["sha256"])
            self.assertEqual(document["certificate"], summary["certificate"])
            self.assertEqual(len(document["nodes"]), summary["nodes"])
            self.assertEqual(len(document["edges"]), summary["edges"])
            for number, node in enumerate(document["nodes"]):
                self.assertEqual(node["id"], number)
            for edge in document["edges"]:
                self.check_edge(document["nodes"], edge)

    def check_edge(self, nodes, edge):
        self.assertEqual(edge["points"][0], nodes[edge["source"]]["position"])
        self.assertEqual(edge["points"][-1], nodes[edge["target"]]["position"])
        self.assertEqual(len(edge["points"]), len(edge["radii"]))
        curve = sum(map(math.dist, edge["curve"], edge["curve"][1:]))
        self.assertAlmostEqual(edge["length"], curve)
        # The curve cuts the corners of the points' way, but may swing a little beside them.
        steps = sum(map(math.dist, edge["points"], edge["points"][1:]))
        self.assertLessEqual(edge["length"], steps * 1.05)
        self.assertGreaterEqual(edge["length"] * (1 + 1e-9),
                                math.dist(edge["points"][0], edge["points"][-1]))
        self.assertAlmostEqual(edge["min_radius"], min(edge["radii"]))
        self.assertAlmostEqual(edge["max_radius"], max(edge["radii"]))

    def test_json_follows_its_schema(self):
        schema = json.loads((harness.SOURCES / "client/export/skeleton.schema.json").read_text())
        for _, document in self.each_skeleton():
            self.check_schema(document, schema, schema, "$")

    def check_schema(self, value, schema, root, where):
        """The part of JSON Schema that our schema uses; an unknown keyword is an error."""
        if "$ref" in schema:
            schema = root["$defs"][schema["$ref"].removeprefix("#/$defs/")]
        known = {"type", "properties", "required", "additionalProperties", "items", "enum",
                 "minimum", "minItems", "maxItems", "pattern", "description", "title", "$schema",
                 "$id", "$defs"}
        self.assertLessEqual(set(schema), known, where)
        types = {"object": dict, "array": list, "string": str, "number": (int, float),
                 "integer": int}
        self.assertIsInstance(value, types[schema["type"]], where)
        if "enum" in schema:
            self.assertIn(value, schema["enum"], where)
        if "minimum" in schema:
            self.assertGreaterEqual(value, schema["minimum"], where)
        if "pattern" in schema:
            self.assertRegex(value, schema["pattern"], where)
        if schema["type"] == "object":
            self.assertLessEqual(set(value), set(schema["properties"]), where)
            self.assertLessEqual(set(schema["required"]), set(value), where)
            for key, inner in value.items():
                self.check_schema(inner, schema["properties"][key], root, f"{where}.{key}")
        if schema["type"] == "array":
            self.assertGreaterEqual(len(value), schema.get("minItems", 0), where)
            self.assertLessEqual(len(value), schema.get("maxItems", math.inf), where)
            for item in value:
                self.check_schema(item, schema["items"], root, where + "[]")

    def test_swc_is_a_forest_of_the_same_components(self):
        for summary, document in self.each_skeleton():
            rows = self.swc_rows()
            places = {tuple(row[2:5]) for row in rows}
            kept = {tuple(n["position"]) for n in document["nodes"] if n["kind"] != "loop"}
            self.assertLessEqual(kept, places)
            junctions = sum(n["kind"] == "junction" for n in document["nodes"])
            self.assertEqual(sum(row[1] == 5 for row in rows), junctions)
            cable = sum(math.dist(row[2:5], rows[row[6] - 1][2:5]) for row in rows if row[6] > 0)
            if document["totals"]["loops"] == 0:
                self.assertAlmostEqual(cable, document["totals"]["length"], delta=0.03 * cable)
            roots = sum(row[6] == -1 for row in rows)
            self.assertEqual(roots, summary["certificate"]["skeleton"]["components"])

    def swc_rows(self):
        """Rows as numbers; strict about what the format demands."""
        rows = []
        with open(self.path("s.swc"), newline="") as file:
            for line in file.read().split("\n")[:-1]:
                if line.startswith("#"):
                    continue
                words = line.split(" ")
                self.assertEqual(len(words), 7, line)
                row = [int(words[0]), int(words[1]), *map(float, words[2:6]), int(words[6])]
                self.assertEqual(row[0], len(rows) + 1, "ids count from 1 without a gap")
                self.assertIn(row[1], (0, 5, 6))
                self.assertTrue(all(math.isfinite(v) for v in row[2:6]))
                self.assertGreater(row[5], 0, "radius")
                self.assertTrue(row[6] == -1 or 1 <= row[6] < row[0], "parent before child")
                rows.append(row)
        return rows

    @unittest.skipIf(pandas is None, "python3-pandas is not installed")
    def test_pandas_reads_the_branch_table(self):
        for summary, document in self.each_skeleton():
            table = pandas.read_csv(self.path("s.csv"), float_precision="round_trip")
            self.assertEqual(len(table), summary["edges"])
            self.assertEqual(list(table.branch_distance), [e["length"] for e in document["edges"]])
            self.assertEqual(list(table.mean_radius),
                             [e["mean_radius"] for e in document["edges"]])
            for row, edge in zip(table.itertuples(), document["edges"]):
                source = document["nodes"][edge["source"]]
                self.assertEqual([row.coord_src_x, row.coord_src_y, row.coord_src_z],
                                 source["position"])
                self.assertEqual((row.node_id_dst, row.skeleton_id),
                                 (edge["target"], source["component"]))

    @unittest.skipIf(vtkGLTFReader is None, "python3-vtk9 is not installed")
    def test_vtk_reads_the_tubes_of_glb_where_the_object_is(self):
        for _, document in self.each_skeleton():
            if not document["edges"]:
                continue
            reader = vtkGLTFReader()
            reader.SetFileName(self.path("s.glb"))
            reader.Update()
            parts = reader.GetOutput().NewIterator()
            bounds, tubes = vtkBoundingBox(), 0
            while not parts.IsDoneWithTraversal():
                bounds.AddBounds(parts.GetCurrentDataObject().GetBounds())
                tubes += 1
                parts.GoToNextItem()
            self.assertEqual(tubes, len(document["edges"]))
            # VTK leaves glTF's y axis up; the world's z is.
            low, high = [0] * 3, [0] * 3
            bounds.GetMinPoint(low)
            bounds.GetMaxPoint(high)
            seen = [(low[0], high[0]), (-high[2], -low[2]), (low[1], high[1])]
            for axis, (least, most) in enumerate(seen):
                places = [p[axis] for e in document["edges"] for p in e["curve"]]
                widest = document["totals"]["max_radius"]
                self.assertGreaterEqual(least, min(places) - widest - 1e-3)
                self.assertLessEqual(least, min(places) + 1e-3)
                self.assertLessEqual(most, max(places) + widest + 1e-3)
                self.assertGreaterEqual(most, max(places) - 1e-3)

    def test_markups_hold_a_curve_per_branch(self):
        for summary, document in self.each_skeleton():
            markups = self.read_json("s.mrk.json")["markups"]
            self.assertEqual(len(markups), summary["edges"])
            for markup, edge in zip(markups, document["edges"]):
                places = [point["position"] for point in markup["controlPoints"]]
                if markup["type"] == "ClosedCurve":
                    places.append(places[0])
                length = sum(map(math.dist, places, places[1:]))
                self.assertAlmostEqual(length, edge["length"], delta=0.1 * edge["length"])

    def test_precomputed_skeletons_hold_the_same_graph(self):
        for shape in ("torus", "tree", "knot"):
            with self.subTest(shape=shape):
                self.folder = self.folders / shape
                words = ("skeletonize", self.path("v.bccb"), "--local", "--json", "-o")
                summary = json.loads(self.succeed(*words, self.path("s.precomputed/")))
                self.assertIn("does not state its unit", summary["outputs"][0]["note"])
                document = self.read_json("s.json")
                vertices, edges, radii = read_precomputed(self.path("s.precomputed"), 1)
                betti = document["certificate"]["skeleton"]
                pieces = pieces_of(len(vertices), edges)
                self.assertEqual(pieces, betti["components"])
                self.assertEqual(len(edges) - len(vertices) + pieces, betti["loops"])
                length = sum(math.dist(vertices[a], vertices[b]) for a, b in edges)
                total = document["totals"]["length"]
                self.assertAlmostEqual(length, total, delta=0.02 * total)
                for node, vertex, radius in zip(document["nodes"], vertices, radii):
                    self.assertAlmostEqual(radius, node["radius"], places=3)
                    if node["kind"] != "loop":
                        self.assertLess(math.dist(vertex, node["position"]), 1e-3)

    def test_convert_writes_the_bytes_of_skeletonize(self):
        endings = ("swc", "vtp", "graphml", "obj", "csv", "mrk.json", "glb")
        for shape in SHAPES:
            self.folder = self.folders / shape
            outputs = harness.outputs(self.path(f"c.{e}") for e in endings)
            self.succeed("convert", self.path("s.json"), *outputs)
            for ending in endings:
                with self.subTest(shape=shape, ending=ending):
                    self.assertEqual((self.folder / f"c.{ending}").read_bytes(),
                                     (self.folder / f"s.{ending}").read_bytes())

    def test_convert_knows_placements_roots_and_preparation(self):
        mask = numpy.zeros((20, 24, 40), "u1")
        mask[4:16, 4:20, 4:36] = mask[8:12, 8:12, 0:40] = 1
        mask[9, 9, 20] = mask[10:14, 15, 20] = 0
        header = (f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 40 24 20\nspace: LPS\n"
                  f"space directions: (0.12,0.16,0) (-0.24,0.18,0) (0,0,0.7)\n"
                  f"space origin: (-1e3,0.1,77.7)\nspace units: \"mm\" \"mm\" \"mm\"\n"
                  f"encoding: raw\n\n")
        (self.folder / "v.nrrd").write_bytes(header.encode() + mask.tobytes())
        endings = ("swc", "vtp", "graphml", "obj", "csv", "mrk.json", "glb")
        for number, words in enumerate((
                ("--fill-cavities", "--denoise", 1), ("--kind", "surface"),
                ("--kind", "isthmus-curve", "--pruning", "length", "--pruning-threshold", 1e-5),
                ("--method", "directional", "--distance", "chamfer"))):
            root = "thickest-end" if number < 2 else "thickest-node"
            options = ("--root", root, "--swc-step", 0.25)
            theirs = harness.outputs(self.path(f"a{number}.{e}") for e in (*endings, "json"))
            mine = harness.outputs(self.path(f"b{number}.{e}") for e in endings)
            # Filling cavities warns.
            made = harness.bccskel("skeletonize", self.path("v.nrrd"), "--local", *words, *options,
                                   *theirs, "-o", self.path(f"a{number}.precomputed"))
            self.assertEqual(made.returncode, 0, made.stderr)
            # A result knows its roots.
            again = options if number % 2 else options[2:]
            self.succeed("convert", self.path(f"a{number}.json"), *again, *mine,
                         "-o", self.path(f"b{number}.precomputed"))
            for ending in (*endings, "precomputed/1", "precomputed/info"):
                with self.subTest(words=words, ending=ending):
                    self.assertEqual((self.folder / f"b{number}.{ending}").read_bytes(),
                                     (self.folder / f"a{number}.{ending}").read_bytes())

    def test_convert_refuses_what_is_no_result(self):
        good = json.loads((self.folders / "tree" / "s.json").read_text())
        output = ("-o", self.path("x.swc"))

        def refused(message, change):
            document = json.loads(json.dumps(good))
            change(document)
            (self.folder / "bad.json").write_text(json.dumps(document))
            self.fail_with(3, message, "convert", self.path("bad.json"), *output)

        refused("nodes is not there", lambda d: d.pop("nodes"))
        refused("placement is not there", lambda d: d.pop("placement"))
        refused("not on the lattice", lambda d: d["nodes"][0]["position"].__setitem__(0, 1e300))
        refused("not on the lattice", lambda d: d["edges"][0]["points"][0].__setitem__(0, 0.123))
        refused("a kind of node", lambda d: d["nodes"][0].update(kind="x"))
        refused("nodes[0].loops is not an integer", lambda d: d["nodes"][0].update(loops=-1))
        refused("edges[0].shifts[0][2] is not", lambda d: d["edges"][0].update(shifts=[[1, 2, 40000]]))
        refused("edges[0] is not an edge with as many births as points",
                lambda d: d["edges"][0].update(births=[1]))
        refused("pruning_level is not", lambda d: d["edges"][0].update(pruning_level="x"))
        refused("preparing[0] is not a step", lambda d: d.update(preparing=[{"step": "x"}]))
        self.fail_with(2, "convert writes .json", "convert", self.folders / "tree" / "s.json",
                       "-o", self.path("x.exr"))
        for ending in ("json", "svg", "html"):
            self.fail_with(2, "--root and --unit are for the other formats", "convert",
                           self.folders / "tree" / "s.json", "--root", "thickest-node",
                           "-o", self.path(f"x.{ending}"))

    def test_a_result_without_its_object_becomes_a_picture_and_itself(self):
        for shape in SHAPES:
            self.folder = self.folders / shape
            result = self.path("s.json")
            endings = ("json", "svg", "swc", "png", "html")
            made = [self.path(f"d.{e}") for e in endings]
            summary = json.loads(self.succeed("convert", result, "--json", *harness.outputs(made)))
            self.assertEqual([file["path"] for file in summary["outputs"]], made)
            self.succeed("view", result, "-o", self.path("e.html"))
            for ending in ("svg", "png"):
                drawn = json.loads(self.succeed("render", result, "--json", "-o", self.path(f"e.{ending}")))
                self.assertEqual((drawn["object"], drawn["triangles"]), ("", 0))
            for ending, same in (("json", "s"), ("swc", "s"), ("svg", "e"), ("png", "e"), ("html", "e")):
                with self.subTest(shape=shape, ending=ending):
                    self.assertEqual((self.folder / f"d.{ending}").read_bytes(),
                                     (self.folder / f"{same}.{ending}").read_bytes())
            picture = xml.etree.ElementTree.parse(self.path("d.svg"))
            self.assertIn("s.json", "".join(picture.getroot().itertext()))

    def test_render_draws_the_object_in_svg_in_its_only_size(self):
        words = ("render", self.folders / "tree" / "s.json", "--object", self.folders / "tree" / "v.bccb",
                 "-o", self.path("x.svg"))
        drawn = json.loads(self.succeed(*words, "--json"))
        self.assertGreater(drawn["triangles"], 100)
        size = xml.etree.ElementTree.parse(self.path("x.svg")).getroot().attrib
        self.assertEqual((str(drawn["width"]), str(drawn["height"])), (size["width"], size["height"]))
        for option in (("--turn", 0), ("--climb", 1), ("--size", "500x500")):
            self.fail_with(2, "are for .png", *words, *option)

    def test_precomputed_skeletons_are_in_nanometers(self):
        (self.folder / "v.nrrd").write_bytes(
            b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 12 3 3\n"
            b"space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
            b"space origin: (5,6,7)\nspace units: \"um\" \"um\" \"um\"\nencoding: raw\n\n" +
            bytes([1]) * 72 + bytes([9]) * 36)
        self.succeed("skeletonize", self.path("v.nrrd"), "--local", "--label", 1,
                     "-o", self.path("w.precomputed"), "-o", self.path("w.json"))
        vertices, edges, radii = read_precomputed(self.path("w.precomputed"), 1)
        nodes = self.read_json("w.json")["nodes"]
        self.assertGreater(len(edges), 0)
        for vertex, radius, node in zip(vertices, radii, nodes):
            self.assertLess(math.dist(vertex, [1000 * c for c in node["position"]]), 0.01)
            self.assertAlmostEqual(radius, 1000 * node["radius"], places=3)
        # Every label is a segment; what is there of others stays.
        self.succeed("labels", self.path("v.nrrd"), "--labels", "9",
                     "-o", self.path("w.precomputed"))
        self.assertEqual(read_precomputed(self.path("w.precomputed"), 1)[0], vertices)
        self.assertGreater(min(v[2] for v in read_precomputed(self.path("w.precomputed"), 9)[0]),
                           max(v[2] for v in vertices))

    def test_a_folder_of_labels_without_a_unit_is_noted(self):
        numpy.save(self.path("labels.npy"), numpy.pad(numpy.ones((3, 3, 12), "u1"), 1))
        for words in (("labels", self.path("labels.npy")),
                      ("skeletonize", self.path("labels.npy"), "--local")):
            said = self.succeed(*words, "-o", self.path("n.precomputed"))
            self.assertRegex(said, r"n\.precomputed[, (]+the input does not state its unit")
            said = self.succeed(*words, "--unit", "micron", "-o", self.path("um.precomputed"))
            self.assertNotIn("unit", said)

    def test_a_unit_is_stated_for_an_image_or_a_result_without_one(self):
        numpy.save(self.path("bar.npy"), numpy.pad(numpy.ones((3, 3, 12), "u1"), 1))
        words = ("skeletonize", self.path("bar.npy"), "--local")
        self.succeed(*words, "--unit", "um", "-o", self.path("um.json"), "-o", self.path("um.csv"))
        self.assertEqual(self.read_json("um.json")["unit"], "um")
        self.assertIn(",um\n", (self.folder / "um.csv").read_text())
        self.succeed(*words, "-o", self.path("none.json"))
        self.succeed("convert", self.path("none.json"), "--unit", "cm", "-o", self.path("cm.csv"), "-o",
                     self.path("cm.mrk.json"))
        self.assertIn(",cm\n", (self.folder / "cm.csv").read_text())
        ends = [point["position"][0] for point in
                self.read_json("cm.mrk.json")["markups"][0]["controlPoints"]]
        self.assertGreater(max(map(abs, ends)), 50)  # mm
        self.fail_with(2, "--unit furlong: must be a unit of length, such as nm, um, mm", *words,
                       "--unit", "furlong", "-o", self.path("x.csv"))

    def test_precomputed_skeletons_do_not_replace_the_info_of_a_volume(self):
        (self.folder / "x.precomputed").mkdir()
        (self.folder / "x.precomputed" / "info").write_text('{"@type":"other"}')
        self.fail_with(8, "does not describe skeletons", "skeletonize",
                       self.folders / "ball" / "v.bccb", "--local",
                       "-o", self.path("x.precomputed"))

    def test_the_world_and_the_unit_are_those_of_the_input(self):
        (self.folder / "v.nhdr").write_text(
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 12 3 3\nspace: right-anterior-superior\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
            "space units: \"mm\" \"mm\" \"mm\"\nencoding: raw\ndata file: v.raw\n")
        (self.folder / "v.raw").write_bytes(bytes([1]) * 107 + bytes(1))
        outputs = harness.outputs(self.path(f"w.{e}")
                                  for e in ("json", "swc", "graphml", "vtp", "mrk.json"))
        self.succeed("skeletonize", self.path("v.nhdr"), "--local", *outputs)
        document = self.read_json("w.json")
        self.assertEqual((document["world"], document["unit"]), ("RAS", "mm"))
        self.assertIn("# world: RAS\n# unit: mm\n", (self.folder / "w.swc").read_text())
        graph = networkx.read_graphml(self.path("w.graphml")).graph
        self.assertEqual((graph["world"], graph["unit"]), ("RAS", "mm"))
        facts = {array.get("Name"): bytes(map(int, array.text.split()[:-1])).decode()
                 for array in xml.etree.ElementTree.parse(self.path("w.vtp")).iterfind(
                     ".//FieldData/DataArray")}
        self.assertEqual((facts["world"], facts["unit"]), ("RAS", "mm"))
        markups = self.read_json("w.mrk.json")["markups"]
        self.assertEqual(markups[0]["coordinateSystem"], "RAS")

    def test_swc_says_which_loops_it_cut(self):
        note = "SWC holds trees only: 1 loop cut"
        self.assertIn(note, self.summaries["torus"]["outputs"][ENDINGS.index("swc")]["note"])
        self.assertIn("# " + note, (self.folders / "torus/s.swc").read_text())

    @unittest.skipIf(networkx is None, "python3-networkx is not installed")
    def test_networkx_reads_graphml_and_finds_the_loops_of_the_certificate(self):
        for summary, document in self.each_skeleton():
            graph = networkx.read_graphml(self.path("s.graphml"), force_multigraph=True)
            betti = summary["certificate"]["skeleton"]
            components = networkx.number_connected_components(graph)
            stated = sum(data.get("loops", 0) for _, data in graph.nodes(data=True))
            cavities = sum(data.get("cavities", 0) for _, data in graph.nodes(data=True))
            loops = graph.number_of_edges() - graph.number_of_nodes() + components + stated
            self.assertEqual((components, loops, cavities), harness.topology(betti))
            for node in document["nodes"]:
                data = graph.nodes[f"n{node['id']}"]
                self.assertEqual([data["x"], data["y"], data["z"]], node["position"])
                self.assertEqual(data["kind"], node["kind"])

    @unittest.skipIf(vtkXMLPolyDataReader is None, "python3-vtk9 is not installed")
    def test_vtk_reads_vtp_with_every_point_and_array(self):
        for _, document in self.each_skeleton():
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path("s.vtp"))
            reader.Update()
            self.assertEqual(reader.GetErrorCode(), 0)
            data = reader.GetOutput()
            self.assertEqual(data.GetNumberOfLines(), len(document["edges"]))
            self.check_vtk_lines(data, document)
            for name in ("radius", "distance", "node_kind"):
                array = data.GetPointData().GetArray(name)
                self.assertEqual(array.GetNumberOfTuples(), data.GetNumberOfPoints())
            for name in ("edge_id", "length"):
                array = data.GetCellData().GetArray(name)
                self.assertEqual(array.GetNumberOfTuples(), data.GetNumberOfCells())

    def check_vtk_lines(self, data, document):
        lines = data.GetNumberOfVerts()  # cells: vertices first
        for number, edge in enumerate(document["edges"]):
            cell = data.GetCell(lines + number)
            points = [list(cell.GetPoints().GetPoint(n)) for n in range(cell.GetNumberOfPoints())]
            self.assertEqual(points, edge["curve"])
            lattice = data.GetPointData().GetArray("lattice")
            self.assertEqual([list(lattice.GetTuple(cell.GetPointId(n)))
                              for n in range(cell.GetNumberOfPoints())], edge["points"])
            self.assertAlmostEqual(data.GetCellData().GetArray("length").GetValue(lines + number),
                                   edge["length"])

    def test_obj_lines_run_over_points_that_exist(self):
        for _, document in self.each_skeleton():
            with open(self.path("s.obj")) as file:
                words = [line.split() for line in file if not line.startswith("#")]
            vertices = [list(map(float, w[1:])) for w in words if w[0] == "v"]
            lines = [list(map(int, w[1:])) for w in words if w[0] == "l"]
            self.assertEqual([[vertices[n - 1] for n in line] for line in lines],
                             [edge["curve"] for edge in document["edges"]])
            self.assertLessEqual({w[0] for w in words}, {"v", "l", "p"})

    def test_svg_is_xml_with_pictures_inside(self):
        for _, document in self.each_skeleton():
            root = xml.etree.ElementTree.parse(self.path("s.svg")).getroot()
            images = root.findall(".//{http://www.w3.org/2000/svg}image")
            self.assertEqual(len(images), 3)
            for image in images:
                head, data = image.attrib["href"].split(",")
                self.assertEqual(head, "data:image/png;base64")
                self.assertTrue(base64.b64decode(data).startswith(b"\x89PNG"))

    @unittest.skipIf(shutil.which("rsvg-convert") is None, "rsvg-convert is not installed")
    def test_librsvg_draws_the_svg(self):
        for _ in self.each_skeleton():
            subprocess.run(["rsvg-convert", "-o", self.path("s.png"), self.path("s.svg")],
                           check=True, timeout=60)

    def test_html_stands_alone_and_its_data_is_json(self):
        for _, document in self.each_skeleton():
            with open(self.path("s.html")) as file:
                text = file.read()
            html.parser.HTMLParser().feed(text)
            packed, data = (re.search(rf'<script id="{name}" type="[^"]*">(.*?)</script>', text,
                                      re.S)[1] for name in ("result", "data"))
            shown = json.loads(zlib.decompress(base64.b64decode(packed)))
            data = json.loads(data)
            self.assertEqual(shown["nodes"], document["nodes"])
            self.assertEqual([e["length"] for e in shown["edges"]],
                             [e["length"] for e in document["edges"]])
            self.assertEqual(data["curves"]["points"],
                             sum(len(e["points"]) for e in document["edges"]))
            self.assertEqual(data["curves"]["radii"],
                             sorted({radius for e in document["edges"] for radius in e["radii"]}))
            self.assertNotIn("timings", shown)
            self.assertGreater(data["layers"][0]["triangles"], 0)

    @unittest.skipIf(shutil.which("exrheader") is None, "openexr is not installed")
    def test_openexr_reads_the_header_of_volumes(self):
        for summary, _ in self.each_skeleton():
            done = subprocess.run(["exrheader", self.path("s.exr")], capture_output=True, text=True,
                                  timeout=60, check=True)
            nx, ny, nz = summary["volume"]["extent"]
            self.assertEqual(done.stdout.count(f"(0 0) - ({nx - 1} {ny - 1})"), 4)
            self.assertEqual(done.stdout.count("32-bit unsigned integer"), 2 * math.ceil(nz / 32))

    @unittest.skipIf(shutil.which("oiiotool") is None, "openimageio-tools is not installed")
    def test_openimageio_reads_the_pixels_of_volumes(self):
        for summary, _ in self.each_skeleton():
            done = subprocess.run(["oiiotool", "--stats", "-a", self.path("s.exr")],
                                  capture_output=True, text=True, timeout=60, check=True)
            nx, ny, nz = summary["volume"]["extent"]
            self.assertRegex(done.stdout, rf"{nx} x\s+{ny}, {math.ceil(nz / 32)} channel, uint")


if __name__ == "__main__":
    harness.main()
