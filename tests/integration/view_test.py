"""Pages that `bccskel view` and `-o x.html` make: what they show, and where they work."""

import functools
import html
import json
import os
import re
import unittest

import numpy

import browser
import harness
import view_samples


@functools.cache
def shared_browser():
    """Starting one, and the first page of each, take as long as four pages more."""
    shared = browser.Browser().__enter__()
    unittest.addModuleCleanup(shared_browser.cache_clear)
    unittest.addModuleCleanup(shared.__exit__, None, None, None)
    return shared


@unittest.skipIf(browser.CHROMIUM is None, "chromium is not installed")
class PageTestCase(harness.TestCase):
    """A test with a browser, which the tests of a program share."""

    def setUp(self):
        super().setUp()
        self.browser = shared_browser()
        self.browser.resize(1200, 800)
        self.browser.prefer(color_scheme="light", reduced_motion="reduce")

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])

    def page(self, shape, points=20000):
        volume = self.generate(shape, points)
        done = harness.bccskel("skeletonize", volume, "--local", "-o", self.path("s.json"))
        self.assertEqual(done.returncode, 0, done.stderr)  # which may warn of cavities
        summary = json.loads(self.succeed("view", self.path("s.json"), "--object", volume,
                                          "-o", self.path("s.html"), "--json"))
        self.assertEqual(summary["bytes"], os.path.getsize(self.path("s.html")))
        return self.read_json("s.json")

    def open_sample(self, sample, address=""):
        view_samples.write(self.folder / "s.json", sample)
        self.succeed("view", self.path("s.json"), "-o", self.path("s.html"))
        return self.open(address)

    def open(self, address=""):
        self.browser.open(self.path("s.html"), address)
        self.assertEqual(self.browser.run("document.documentElement.dataset.state"), "ready")
        return self.browser

    def slide(self, slider, value):
        """Moves a slider as dragging it would."""
        self.browser.run(f"""(() => {{
          const slider = document.getElementById("{slider}");
          slider.value = {value};
          slider.dispatchEvent(new Event("input", {{ bubbles: true }}));
        }})()""")
        self.browser.settle()

    def place(self, edge):
        """Where the middle of an edge is in the window."""
        return self.browser.run(f"""(() => {{
          const at = {{}}, middle = (curveStart[{edge}] + curveStart[{edge} + 1]) >> 1;
          projector()(...curvePoint(middle).toArray(), at);
          const box = canvas.getBoundingClientRect();
          return [box.x + at.x, box.y + at.y];
        }})()""")

    def pins(self):
        return self.browser.run(
            "[...document.querySelectorAll('#pinned .go')].map((b) => b.textContent)")

    def column(self, name):
        return self.browser.run(f"""[...document.querySelectorAll("#body .{name}")]
            .map((cell) => cell.textContent)""")


class ViewTest(PageTestCase):
    def test_the_skeleton_alone_is_shown(self):
        page = self.open_sample(view_samples.forest(3))
        self.assertTrue(page.run("document.querySelector('section.of-object').hidden"))

    def test_skeletonize_writes_the_page_with_the_shells_as_they_were_taken(self):
        volume = self.generate("tree", 20000)
        self.succeed("skeletonize", volume, "--local", "-o", self.path("s.html"))
        self.assertRegex(self.open("#peel=1").text("#shells"), r"^\d+ of \d+ shells off$")

    def test_every_kind_of_object_is_shown_without_a_complaint(self):
        for shape, cavities in (("tree", "0"), ("hollow-ball", "1")):
            with self.subTest(shape=shape):
                self.page(shape)
                page = self.open()
                self.assertEqual(page.text("#verdict"), "\u2713 topology kept")
                self.assertEqual(
                    page.run("[...document.querySelectorAll('#certificate td')]"
                             ".map((cell) => cell.textContent).join()"),
                    f"1,1,0,0,{cavities},{cavities}")

    def test_the_verdict_says_what_changed_before_thinning(self):
        line = numpy.zeros((5, 5, 21), "u1")
        line[2, 2, ::2] = 1
        numpy.save(self.path("line.npy"), line)
        harness.bccskel("skeletonize", self.path("line.npy"), "--local", "--sampling", "trilinear",
                        "--density", "0.5", "-o", self.path("s.html"))  # warns, too
        self.assertRegex(self.open().text("#verdict"), "^topology kept by thinning; sampling changed components 11 \u2192 ")
        harness.bccskel("skeletonize", self.path("line.npy"), "--local", "--min-component", "100",
                        "-o", self.path("s.html"))  # which is not sampling
        self.assertEqual(self.open().text("#verdict"),
                         "topology kept by thinning; preparing changed components 11 \u2192 0")

    def test_curves_lead_from_node_to_node(self):
        self.page("tree")
        self.assertEqual(self.open().run("""result.edges.filter((e, id) =>
            [[curveStart[id], e.source], [curveStart[id + 1] - 1, e.target]].some(([at, node]) =>
              curvePoint(at).distanceTo(new THREE.Vector3(...toScene(nodeAt[node].position))) > 1e-6)
            || curvePoints.slice(3 * curveStart[id], 3 * curveStart[id + 1]).some((v) => !(v > 0 && v < 1))
          ).length"""), 0)

    def test_the_peeled_object_is_seen(self):
        self.page("tree")
        pictures = []
        self.open("#peel=2")
        pictures.append(self.browser.picture())
        for address in ("#", "#theme=dark", "#prune=20", "#cut=y_0.5", "#cut=y_0.5_back",
                        "#off=object", "#off=skeleton", "#off=nodes", "#glass=1", "#color=branch",
                        "#flat=1"):
            self.browser.follow(address)
            pictures.append(self.browser.picture())
        self.assertEqual(len(set(pictures)), 12)
        for picture in pictures:
            self.assertGreater(len(picture), 30000)  # a blank page is smaller

    def test_through_the_cut_one_sees_the_inside(self):
        self.page("ball")
        page = self.open("#cut=z_0.5&off=skeleton.nodes")
        page.click('[data-look="+z"]')
        page.settle()
        page.run("cutFrame.visible = false")
        middle, corner = page.run("""(() => {
          draw();
          const gl = renderer.getContext(), color = (x, y) => {
            const pixel = new Uint8Array(4);
            gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            return pixel.join();
          };
          return [color(canvas.width >> 1, canvas.height >> 1), color(1, 1)];
        })()""")
        self.assertNotEqual(middle, corner)

    def test_a_surface_skeleton_is_seen_as_a_sheet(self):
        volume = self.generate("box")
        pictures = set()
        for kind in ("surface", "curve"):
            self.succeed("skeletonize", volume, "--local", "--kind", kind, "-o",
                         self.path("s.html"))
            self.open()
            pictures.add(self.browser.picture())
        self.assertEqual(len(pictures), 2)

    def test_pruning_counts_what_another_run_with_that_threshold_counts(self):
        for shape, steps in (("tree", (1, 9, 20)), ("torus", (1,))):
            with self.subTest(shape=shape):
                volume = self.path("object.bccb")
                noise = 0.1 if shape == "torus" else 0
                self.succeed("generate", shape, "--points", 20000, "--noise", noise, "-o", volume)
                self.summarize("skeletonize", volume, "--local", "--pruning", "none", "-o",
                               self.path("s.html"))
                page = self.open()
                levels = page.run("levels")
                for step in steps:
                    after = levels[step] if step < len(levels) else levels[-1] + 1
                    self.summarize("skeletonize", volume, "--local", "--pruning-threshold",
                                   (levels[step - 1] + after) / 2, "-o", self.path("pruned.json"))
                    pruned = self.read_json("pruned.json")
                    self.slide("prune", step)
                    nodes, branches = map(int, re.match(
                        r"(\d+) nodes?, (\d+) branch", page.text("#counts")).groups())
                    self.assertEqual((nodes, branches),
                                     (len(pruned["nodes"]), len(pruned["edges"])))
                    kinds = page.run("shown.nodes.map(shown.kindOf).sort()")
                    self.assertEqual(kinds, sorted(n["kind"] for n in pruned["nodes"]))

    @harness.needs_data("mesh")
    def test_pruning_counts_what_another_run_counts_on_real_objects(self):
        objects = [(harness.DATA / "mesh" / name, ["--points", 60000])
                   for name in ("armadillo_86k.ply", "gmsh_t13.stl")]
        # Where the border cuts limbs off, tips may lead curves there that pruning has removed.
        objects += [(harness.DATA / "volume" / name, ["--border", "ends"])
                    for name in ("neuron_28018323.nrrd", "airway_p4_chopped.nrrd")]
        for (file, options), part in zip(objects, (0.3, 0.8, 0.3, 0.8)):
            self.summarize("skeletonize", file, *options, "--local", "--pruning", "none", "-o",
                           self.path("s.html"))
            page = self.open("#off=object.skeleton.nodes")  # it is counted, not seen
            levels = page.run("levels")
            all_levels = page.run("[...new Set(levelOf)].filter(Number.isFinite)")
            step = max(1, round(part * len(levels)))
            higher = [level for level in all_levels if level > levels[step - 1]]
            threshold = (levels[step - 1] + min(higher, default=1e3)) / 2
            with self.subTest(file=file.name, threshold=threshold):
                self.summarize("skeletonize", file, *options, "--local",
                               "--pruning-threshold", threshold, "-o", self.path("pruned.json"))
                pruned = self.read_json("pruned.json")
                self.slide("prune", step)
                self.assertEqual(page.run("shown.nodes.map(shown.kindOf).sort()"),
                                 sorted(n["kind"] for n in pruned["nodes"]))
                self.assertEqual(page.run("shown.branches.size"), len(pruned["edges"]))

    def test_a_loop_without_its_stem_is_one_branch_at_a_node_of_its_own(self):
        page = self.open_sample(view_samples.lasso())
        self.assertTrue(page.text("#counts").startswith("2 nodes, 2 branches"))
        self.slide("prune", 1)
        self.assertRegex(page.text("#counts"), "^1 node, 1 branch, length [0-9.]+ \u00b5m$")
        page.click("#dock-toggle")
        self.assertEqual(page.text("#row-0 .kinds"), "loop")

    def test_branches_that_meet_where_no_junction_is_left_are_one(self):
        page = self.open_sample(view_samples.fork(), "#prune=1")
        page.click("#dock-toggle")
        self.assertEqual(page.text("#row-0 .kinds"), "end \u2013 end")
        self.assertIn("\n0,0,1,2,0,", page.run("branchCsv()"))  # branch_type 0

    def test_figures_are_in_the_unit_of_the_result(self):
        page = self.open_sample(view_samples.forest(3))
        page.click("#dock-toggle")
        self.assertEqual(page.text("#points"), "1,234 points \u00b7 RAS \u00b7 mm")
        self.assertEqual(page.text("#counts"), "12 nodes, 9 branches, length 30 mm")
        self.assertRegex(page.text("#scale"), r"^\d+ mm$")
        self.assertEqual(page.text("#most"), "2 mm")
        self.assertIn("Mean radius (mm)", page.text("#heads"))

    def test_a_unit_is_text_and_no_markup(self):
        sample = view_samples.forest(3)
        sample["unit"] = "<i>mm</i>"
        page = self.open_sample(sample)
        page.click("#dock-toggle")
        self.assertIn("Mean radius (<i>mm</i>)", page.text("#heads"))
        page.run("tell(aboutNode(0), 9, 9)")
        self.assertIn("<i>mm</i>", page.text("#tip"))

    def test_the_scale_is_as_long_as_it_says(self):
        page = self.open_sample(view_samples.forest(3), "#view=0_0_2_0.5_0.5_0.5")
        for flat in ("false", "true"):
            self.assertEqual(page.run("document.getElementById('flat').ariaPressed"), flat)
            length = page.run("parseFloat(document.getElementById('scale').textContent)")
            # Along x through what the camera turns around.
            between = page.run(f"""(() => {{
              const project = projector(), a = {{}}, b = {{}}, {{ x, y, z }} = view.target;
              project(x, y, z, a);
              project(x + {length} / edge, y, z, b);
              return b.x - a.x;
            }})()""")
            width = page.run("parseFloat(document.getElementById('bar').style.width)")
            self.assertAlmostEqual(between, width, delta=0.01)
            page.key("o")
            page.settle()

    def test_colors_change_the_legend(self):
        page = self.open_sample(view_samples.forest(3))
        told = {}
        for name in page.run("[...document.getElementById('color').options].map((o) => o.value)"):
            page.run(f"""(() => {{ const color = document.getElementById("color");
              color.value = "{name}";
              color.dispatchEvent(new Event("input", {{ bubbles: true }})); }})()""")
            told[name] = (page.text("#least"), page.text("#most"),
                          page.run("document.getElementById('ramp').hidden"))
        self.assertEqual(told["radius"], ("radius 1", "2 mm", False))
        self.assertEqual(told["length"], ("length 2", "4 mm", False))
        self.assertEqual(told["pruning"], ("pruning level 1", "3", False))
        self.assertTrue(told["branch"][2])
        self.assertEqual(len(told), 4)

    def test_the_system_says_whether_it_is_dark(self):
        page = self.open_sample(view_samples.forest(1))
        paper = "getComputedStyle(document.body).backgroundColor"
        light = page.run(paper)
        page.prefer(color_scheme="dark")
        page.settle()
        self.assertNotEqual(page.run(paper), light)
        page.click("#theme")
        self.assertEqual(page.run(paper), light)

    def test_nothing_is_outside_of_a_narrow_window(self):
        page = self.open_sample(view_samples.forest(30))
        for width, height in ((360, 640), (760, 500), (1600, 900)):
            page.resize(width, height)
            self.open()
            page.click("#dock-toggle")
            page.settle()
            outside = page.run("""[...document.querySelectorAll(
                "#tools *, #bar-of-dock *, #legend, #ruler")]
              .filter((e) => e.checkVisibility() && e.getBoundingClientRect().width > 0)
              .filter((e) => { const b = e.getBoundingClientRect();
                return b.left < 0 || b.top < 0 || b.right > innerWidth || b.bottom > innerHeight; })
              .map((e) => e.id || e.tagName)""")
            self.assertEqual(outside, [], width)
            self.assertEqual(page.run("document.documentElement.scrollWidth"), width)

    def test_the_whole_object_is_seen_at_first_and_after_a_reset(self):
        page = self.open_sample(view_samples.forest(30, columns=2))
        for width, height in ((360, 640), (1600, 500)):
            page.resize(width, height)
            self.open()
            for dock in ("closed", "open"):
                low, high = page.run("""(() => {
                  const project = projector(), at = {}, x = [], y = [];
                  for (let n = 0; n < pointCount; ++n) {
                    project(...curvePoint(n).toArray(), at);
                    x.push(at.x / drawn.width);
                    y.push(at.y / drawn.height);
                  }
                  return [Math.min(...x, ...y), Math.max(...x, ...y)];
                })()""")
                self.assertGreater(low, 0, (width, dock))
                self.assertLess(high, 1, (width, dock))
                self.assertGreater(high - low, 0.6, (width, dock))
                page.click("#dock-toggle")
                page.scroll(width // 2, 100, -900)
                page.click("#reset")
                page.settle()

    def test_an_empty_skeleton_and_a_point_are_shown(self):
        page = self.open_sample(view_samples.document([], []))
        page.click("#dock-toggle")
        self.assertTrue(page.text("#counts").startswith("0 nodes, 0 branches"))
        self.assertEqual(page.text("#none"), "No branches are shown.")
        blank = page.picture()
        point = view_samples.node(0, "isolated", [5, 6, 7], radius=3)
        page = self.open_sample(view_samples.document([point], []))
        self.assertTrue(page.text("#counts").startswith("1 node, 0 branches"))
        page.click("#dock-toggle")
        self.assertNotEqual(page.picture(), blank)
        page.move(*page.run("""(() => { const box = canvas.getBoundingClientRect();
          return [box.x + box.width / 2, box.y + box.height / 2]; })()"""))
        page.settle()
        self.assertIn("isolated 0", page.text("#tip"))
        self.assertIn("5, 6, 7 mm", page.text("#tip"))
        self.assertRegex(page.text("#scale"), "^[12] mm$")  # its ball has a radius of 3 mm

    def test_a_huge_result_is_shown(self):
        page = self.open_sample(view_samples.forest(6000, columns=80), "#off=skeleton.nodes")
        self.assertTrue(page.text("#counts").startswith("24,000 nodes, 18,000 branches"))
        page.click("#dock-toggle")
        self.assertLess(page.run("document.querySelectorAll('#body > div').length"), 40)

    def test_the_page_works_inside_of_another_as_in_a_notebook(self):
        self.open_sample(view_samples.forest(2))
        text = html.escape((self.folder / "s.html").read_text())
        outer = self.folder / "notebook.html"
        outer.write_text(f"""<html data-state="ready"><iframe srcdoc="{text}"
            style="width: 900px; height: 600px"></iframe></html>""")
        self.browser.open(outer)
        inner = "document.querySelector('iframe')?.contentDocument"
        # The page around it is ready before the frame has a document of its own.
        self.browser.wait(f"{inner}?.documentElement?.dataset.state === 'ready'")
        for button in ("dock-toggle", "copy-link"):
            self.browser.run(f"{inner}.getElementById('{button}').click()")
        self.browser.wait(f"{inner}.getElementById('toast').textContent.includes('no address')")
        self.assertEqual(self.browser.run(f"{inner}.querySelectorAll('#body > div').length"), 6)

    def test_what_fails_is_said_in_words(self):
        self.open_sample(view_samples.forest(1))
        page = self.folder / "s.html"
        page.write_text(page.read_text().replace('"layers":', '"others":'))
        self.browser.open(str(page))
        self.assertEqual(self.browser.run("document.documentElement.dataset.state"), "failed")
        self.assertTrue(self.browser.text("#message").startswith("This page could not be built: "))
        self.assertNotEqual(self.browser.complaints, [])
        self.browser.complaints.clear()


@unittest.skipIf(browser.CHROMIUM is None, "chromium is not installed")
class NoGraphicsTest(harness.TestCase):
    def test_without_webgl_the_page_says_so_and_the_table_works(self):
        view_samples.write(self.folder / "s.json", view_samples.forest(4))
        self.succeed("view", self.path("s.json"), "-o", self.path("s.html"))
        with browser.Browser("--disable-3d-apis") as page:
            page.open(self.path("s.html"))
            self.assertEqual(page.run("document.documentElement.dataset.state"), "ready")
            self.assertIn("WebGL", page.text("#message"))
            page.click("#dock-toggle")
            page.click("#row-2")
            self.assertEqual(page.run("document.querySelector('#row-2').ariaSelected"), "true")
            self.assertIn("branch_distance", page.run("branchCsv()"))


if __name__ == "__main__":
    harness.main()
