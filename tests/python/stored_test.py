"""Skeletons that are read, pickled and copied."""

import copy
import json
import multiprocessing
import pickle
import warnings

import bccskel
import harness
import numpy

from shapes import box_mesh, crossing_bars

GRAPH_ENDINGS = (".swc", ".vtp", ".graphml", ".obj", ".csv", ".glb", ".mrk.json")


def skeletonize_slab(width):
    return bccskel.skeletonize(numpy.ones((width, 9, 40)), root="thickest-end")


class PickleTest(harness.TestCase):
    def assert_same(self, mine, theirs, endings=(".json", ".vtp", ".swc")):
        self.assertEqual((mine.sha256, mine.certificate, mine.options, mine.method, mine.title,
                          mine.label, mine.axes, mine.voxels, mine.warnings, mine.notes, mine.unit),
                         (theirs.sha256, theirs.certificate, theirs.options, theirs.method,
                          theirs.title, theirs.label, theirs.axes, theirs.voxels, theirs.warnings,
                          theirs.notes, theirs.unit))
        numpy.testing.assert_array_equal(mine.nodes, theirs.nodes)
        numpy.testing.assert_array_equal(mine.pruning_levels, theirs.pruning_levels)
        for ending in endings:
            written = []
            for skeleton in (mine, theirs):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    skeleton.save(self.path("one" + ending))
                written.append((self.folder / ("one" + ending)).read_bytes())
            self.assertEqual(*written)

    def test_a_copy_is_whole(self):
        mask = crossing_bars()
        skeletons = {
            "mask": bccskel.skeletonize(mask, spacing=(3, 2, 1), root="thickest-end"),
            "sampling": bccskel.skeletonize(mask, sampling="trilinear"),
            "prepared": bccskel.skeletonize(mask, denoise=1, keep_largest=True),
            "surface": bccskel.skeletonize(mask, kind="surface"),
            "mesh": bccskel.skeletonize_mesh(*box_mesh(), points=2000),
            "label": bccskel.skeletonize_labels(mask.astype("u1") * 7)[7],
            "nothing": bccskel.skeletonize(numpy.zeros((3, 3, 3))),
        }
        for name, skeleton in skeletons.items():
            with self.subTest(name):
                pickled = pickle.loads(pickle.dumps(skeleton))
                self.assertEqual(pickled.timings, skeleton.timings)
                for again in (pickled, copy.deepcopy(skeleton), copy.copy(skeleton)):
                    self.assert_same(again, skeleton)
                self.assert_same(pickled, skeleton, (".svg", ".html", ".glb"))
                if name in ("mask", "label"):
                    numpy.testing.assert_array_equal(pickled.branch_image(),
                                                     skeleton.branch_image())
                if name in ("mask", "mesh"):
                    self.assert_same(pickled, skeleton, (".exr", ".bccb"))

    def test_processes_hand_over_skeletons(self):
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            for width, theirs in zip((5, 9), pool.map(skeletonize_slab, (5, 9))):
                self.assert_same(theirs, skeletonize_slab(width), (".vtp", ".swc"))
                self.assertIsNotNone(theirs.order)

    def test_damaged_pickles_are_refused(self):
        state = bccskel.skeletonize(numpy.ones((5, 5, 30)))._outcome.__getstate__()
        whole = state["result"]
        kind = type(bccskel.skeletonize(numpy.ones((3, 3, 3)))._outcome)
        for damaged in (b"", whole[:-1], whole[1:], whole[:40] + b"\xff" + whole[41:]):
            with self.assertRaises((ValueError, RuntimeError)):
                kind.__new__(kind).__setstate__({**state, "result": damaged})

    def test_pickles_that_contradict_themselves_are_refused(self):
        labels = bccskel.skeletonize_labels(crossing_bars().astype("u1"), root="thickest-end")
        outcome = labels[1]._outcome
        state = outcome.__getstate__()
        runs = state["label"][4]
        for name, value in (
                ("root", (0, (0, 0, 0), [1000])), ("root", (9, (0, 0, 0), [])),
                ("label", (*state["label"][:4], runs + (0, 0, 0, 1000))),
                ("label", (*state["label"][:4], runs - (1000, 0, 0, 0))),
                ("grid", None), ("grid", (-1, *state["grid"][1:])), ("mask", (7, 0, None))):
            with self.subTest(name), self.assertRaisesRegex(ValueError, "damaged pickle"):
                type(outcome).__new__(type(outcome)).__setstate__({**state, name: value})


class ReadTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.image = self.path("mask.npy")
        numpy.save(self.image, crossing_bars())

    def result(self, *words):
        self.succeed("skeletonize", self.image, "--local", *words, "-o", self.path("a.json"),
                     "-o", self.path("a.bccb"))
        return bccskel.read(self.path("a.json"))

    def test_a_result_is_a_skeleton(self):
        words = ("--voxel-size", "1,2,3", "--fill-cavities", "--denoise", "1")
        skeleton = self.result(*words)
        document = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(skeleton.sha256, document["sha256"])
        self.assertEqual((skeleton.method, skeleton.options, skeleton.title, skeleton.axes),
                         (document["method"], document["options"], "a", "xyz"))
        for name in ("mask", "unprepared", "input", "skeleton"):
            self.assertEqual(skeleton.certificate[name], document["certificate"][name])
        self.assertTrue(skeleton.certificate["topology_kept"])
        numpy.testing.assert_allclose(skeleton.nodes,
                                      [node["position"] for node in document["nodes"]])
        self.assertEqual(len(skeleton.to_pandas()), len(document["edges"]))
        self.assertIsNone(skeleton.order)
        self.assertIsNone(skeleton.voxels)

    def test_it_is_saved_as_convert_does(self):
        for words in ((), ("--root", "thickest-end"), ("--root", "thickest-node")):
            read = self.result(*words)
            for ending in GRAPH_ENDINGS:
                self.succeed("convert", self.path("a.json"), "-o", self.path("theirs" + ending))
            for skeleton in (read, pickle.loads(pickle.dumps(read))):
                for ending in GRAPH_ENDINGS:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        skeleton.save(self.path("mine" + ending))
                    self.assertEqual((self.folder / ("mine" + ending)).read_bytes(),
                                     (self.folder / ("theirs" + ending)).read_bytes(),
                                     (words, ending))
        for skeleton in (read, pickle.loads(pickle.dumps(read))):
            skeleton.save(self.path("mine.json"))
            self.assertEqual((self.folder / "mine.json").read_bytes(),
                             (self.folder / "a.json").read_bytes())
            for ending, begin in ((".svg", b"<?xml"), (".png", b"\x89PNG"), (".html", b"<!")):
                self.succeed("convert", self.path("a.json"), "-o", self.path("a" + ending))
                skeleton.save(self.path("mine" + ending))
                mine = (self.folder / ("mine" + ending)).read_bytes()
                self.assertTrue(mine.startswith(begin))
                if ending == ".svg":  # the titles differ
                    theirs = (self.folder / "a.svg").read_bytes()
                    self.assertEqual(mine.replace(b">a<", b">a.json<"), theirs)
            self.assertIn("<!", skeleton.page().html)
        with self.assertRaisesRegex(ValueError, r"no lattice points; .* with skeletonize\(\)$"):
            read.save(self.path("mine.exr"))
        with self.assertRaisesRegex(ValueError, "read from a file does not contain the voxels"):
            read.curve_image()

    def test_it_has_the_roots_of_the_result(self):
        for root in ("thickest-node", "node:2"):
            skeleton = self.result("--root", root)
            theirs = bccskel.skeletonize(crossing_bars(), root=root)
            for again in (skeleton, pickle.loads(pickle.dumps(skeleton))):
                self.assertEqual(again.order.keys(), theirs.order.keys())
                for name, values in theirs.order.items():
                    numpy.testing.assert_array_equal(again.order[name], values)

    def test_a_lattice_is_an_object(self):
        self.succeed("voxelize", self.image, "-o", self.path("object.exr"))
        lattice = bccskel.read(self.path("object.exr"))
        self.succeed("skeletonize", self.path("object.exr"), "--local", "--method", "directional",
                     "-o", self.path("b.json"))
        mine = bccskel.skeletonize(lattice, method="directional")
        self.assertEqual(mine.sha256, json.loads((self.folder / "b.json").read_text())["sha256"])
        self.assertEqual((lattice.points % 2).std(axis=1).max(), 0)
        thin = self.result() and bccskel.read(self.path("a.bccb"))
        places = {tuple(place) for place in thin.coordinates.round(6)}
        self.assertTrue(all(tuple(node) in places
                            for node in bccskel.read(self.path("a.json")).nodes.round(6)))
        for wrong in ({"spacing": 2}, {"points": 5}, {"axes": "xyz"}):
            with self.assertRaisesRegex(TypeError, "Lattice"):
                bccskel.skeletonize(lattice, **wrong)

    def test_other_documents_are_refused(self):
        for text in ("", "[]", "{}", '{"nodes": [], "edges": 3}'):
            (self.folder / "b.json").write_text(text)
            with self.assertRaisesRegex(ValueError, "JSON"):
                bccskel.read(self.path("b.json"))
        with self.assertRaises(FileNotFoundError):
            bccskel.read(self.path("none.json"))
        (self.folder / "b.exr").write_bytes(b"no volume")
        with self.assertRaises(ValueError):
            bccskel.read(self.path("b.exr"))


if __name__ == "__main__":
    harness.main()
