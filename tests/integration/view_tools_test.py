"""What one does with a page of `bccskel view`: point, pin, list, cut, turn and link."""

import csv
import io
import urllib.parse

import browser
import harness
import numpy
import view_samples
from view_test import PageTestCase

EMPTY = (300, 700)  # a place of the window where nothing is drawn


class PinTest(PageTestCase):
    def tip(self):
        return dict(self.browser.run("""[...document.querySelectorAll("#tip tr")]
            .map((row) => [...row.children].map((cell) => cell.textContent))"""))

    def test_pointing_at_a_branch_highlights_it_and_tells_its_figures(self):
        page = self.open_sample(view_samples.forest(3))
        page.move(*self.place(1))
        page.settle()
        self.assertEqual(page.text("#tip b"), "branch 1")
        self.assertIn("end \u2013 junction", page.text("#tip"))
        told = self.tip()
        self.assertEqual(told["length"], "4 mm")
        self.assertEqual(told["mean radius"], "1.2 mm")
        self.assertEqual(told["min, max radius"], "1, 2 mm")
        self.assertEqual(told["tortuosity"], "1")
        self.assertTrue(page.run("hoverMark.mesh.visible"))
        lit = page.picture()
        page.move(*EMPTY)
        page.settle()
        self.assertTrue(page.run("document.getElementById('tip').hidden"))
        self.assertFalse(page.run("hoverMark.mesh.visible"))
        self.assertNotEqual(page.picture(), lit)

    def test_every_branch_of_a_real_result_can_be_pointed_at(self):
        result = self.page("tree", 5000)
        page = self.open("#off=nodes")
        found = 0
        for number, edge in enumerate(result["edges"]):
            page.move(*self.place(number))
            page.settle()
            if page.text("#tip b") != f"branch {number}":
                continue  # another one is in front
            found += 1
            self.assertAlmostEqual(float(self.tip()["length"]), edge["length"],
                                   delta=0.001 * edge["length"])
        self.assertGreater(found, 0.8 * len(result["edges"]))

    def test_clicks_pin_several_branches_and_escape_unpins_them(self):
        page = self.open_sample(view_samples.forest(3))
        for edge in (1, 3, 6):
            page.press(*self.place(edge))
        self.assertEqual(self.pins(), ["1", "3", "6"])
        self.assertEqual(page.run("document.getElementById('labels').children.length"), 3)
        page.press(*self.place(3))
        self.assertEqual(self.pins(), ["1", "6"])
        page.click("#pinned .off")
        self.assertEqual(self.pins(), ["6"])
        page.press(*EMPTY)
        self.assertEqual(self.pins(), ["6"])
        page.key("Escape")
        self.assertEqual(self.pins(), [])
        self.assertTrue(page.run("document.getElementById('pins').hidden"))

    def test_a_pin_can_be_taken_off_in_a_narrow_window(self):
        self.browser.resize(360, 640)
        page = self.open_sample(view_samples.forest(3))
        page.press(*self.place(4))
        self.assertEqual(self.pins(), ["4"])
        self.assertLessEqual(page.run(
            "document.querySelector('#pinned .off').getBoundingClientRect().right"), 360)
        page.click("#pinned .off")
        self.assertEqual(self.pins(), [])

    def test_drags_turn_and_pan_and_pin_nothing(self):
        page = self.open_sample(view_samples.forest(3))
        turn, target, (x, y) = page.run("view.turn"), page.run("view.target"), self.place(1)
        page.drag((x, y), (x + 80, y + 20), (x, y))
        self.assertEqual(self.pins(), [])
        page.drag((x, y), (x + 80, y + 20))
        self.assertNotEqual(page.run("view.turn"), turn)
        self.assertEqual(page.run("view.target"), target)
        page.settle()
        x, y = self.place(1)
        page.drag((x, y), (x + 40, y + 30), button="right")
        page.settle()
        for now, then in zip(self.place(1), (x + 40, y + 30)):
            self.assertAlmostEqual(now, then, delta=8)  # it is not at the target's distance

    def test_a_pin_follows_its_branch_when_pruning_joins_it_to_another(self):
        page = self.open_sample(view_samples.forest(3))
        for edge in (1, 2):
            page.press(*self.place(edge))
        self.slide("prune", 1)
        self.assertEqual(self.pins(), ["0"])  # the branches 0 and 1; 2 is gone
        self.slide("prune", 0)
        self.assertEqual(self.pins(), ["1", "2"])


class TableTest(PageTestCase):
    def test_columns_sort_both_ways(self):
        page = self.open_sample(view_samples.forest(4))
        page.click("#dock-toggle")
        self.assertEqual(self.column("id"), [str(n) for n in range(12)])
        page.click("[data-key=length]")
        self.assertEqual(self.column("length"), ["2"] * 4 + ["4"] * 8)
        page.click("[data-key=length]")
        self.assertEqual(self.column("length"), ["4"] * 8 + ["2"] * 4)
        self.assertEqual(page.run("document.querySelector('[aria-sort=descending]').textContent"),
                         "Length (mm)")
        page.click("[data-key=level]")
        self.assertEqual(self.column("level"), ["1", "2", "3", "4"] + [""] * 8)
        page.click("[data-key=level]")
        self.assertEqual(self.column("level"), ["4", "3", "2", "1"] + [""] * 8)

    def test_the_filter_takes_numbers_words_and_conditions(self):
        page = self.open_sample(view_samples.forest(4))
        for text, ids in (("7", ["7"]), ("length<3", ["2", "5", "8", "11"]),
                          ("junction length>=4 component=2", ["6", "7"]),
                          ("pruning>2", ["8", "11"]),
                          ("loop", [])):
            page.run("document.getElementById('search').select()")
            page.click("#search")
            page.run("document.getElementById('search').select()")
            page.type(text)
            page.settle()
            self.assertEqual(self.column("id"), ids, text)
        self.assertEqual(page.text("#none"), "Nothing matches the filter.")
        self.assertEqual(page.text("#found"), "0 of 12")

    def test_a_click_on_a_row_selects_and_centers_its_branch(self):
        page = self.open_sample(view_samples.forest(9))
        page.click("#dock-toggle")
        page.click("#row-4")
        page.settle()
        self.assertEqual(self.pins(), ["4"])
        self.assertEqual(page.run("document.querySelector('#row-4').ariaSelected"), "true")
        x, y = self.place(4)
        box = page.run("(({ x, y, width, height }) => [x + width / 2, y + height / 2])"
                       "(canvas.getBoundingClientRect())")
        self.assertAlmostEqual(x, box[0], delta=1)
        self.assertAlmostEqual(y, box[1], delta=1)

    def test_keys_move_through_the_rows_and_pin(self):
        page = self.open_sample(view_samples.forest(400))
        page.key("b")
        page.run("document.getElementById('rows').focus()")
        page.key("ArrowDown", "ArrowDown", "Enter")
        self.assertEqual(self.pins(), ["2"])
        page.key("End", " ")
        self.assertEqual(self.pins(), ["2", "1199"])
        active = page.run("document.getElementById('rows').getAttribute('aria-activedescendant')")
        self.assertEqual(active, "row-1199")
        self.assertTrue(page.run(f"""(() => {{
          const row = document.getElementById("{active}").getBoundingClientRect();
          return row.bottom <= document.getElementById("rows").getBoundingClientRect().bottom;
        }})()"""))
        page.key("Home", "Enter", "Escape")
        self.assertEqual(self.pins(), [])
        page.key("/")
        page.type("5")
        page.settle()
        self.assertEqual(self.column("id"), ["5"])

    def test_few_rows_are_elements_and_any_can_be_scrolled_to(self):
        page = self.open_sample(view_samples.forest(1700, columns=40))
        page.click("#dock-toggle")
        page.settle()
        page.run("document.getElementById('rows').scrollTop = 28 * 3000")
        page.settle()
        ids = list(map(int, self.column("id")))
        self.assertIn(3001, ids)
        self.assertLess(len(ids), 40)

    def test_components_are_hidden_and_shown(self):
        page = self.open_sample(view_samples.forest(4))
        page.click("#tab-components")
        self.assertEqual(self.column("branches"), ["3"] * 4)
        whole = page.picture()
        page.click("#row-1")
        page.settle()
        self.assertEqual(page.text("#counts"), "12 nodes, 9 branches, length 30 mm")
        self.assertEqual(page.text("#count-components"), "3 of 4")
        self.assertNotEqual(page.picture(), whole)
        page.move(*self.place(3))
        page.settle()
        self.assertTrue(page.run("document.getElementById('tip').hidden"))
        page.click("#row-2 .only")
        self.assertEqual(page.text("#counts"), "4 nodes, 3 branches, length 10 mm")
        page.click("#tab-branches")
        self.assertEqual(self.column("id"), ["6", "7", "8"])
        self.assertEqual(page.run("""[...result.edges.keys()].filter((id) =>
            tubes.geometry.index.array.slice(0, tubes.geometry.drawRange.count)
              .some((at) => at >= kSides * ringStart[id] && at < kSides * ringStart[id + 1]))"""),
                         [6, 7, 8])
        self.slide("prune", 3)
        self.assertEqual(self.column("id"), ["6"])
        self.assertEqual(page.text("#counts"), "2 nodes, 1 branch, length 8 mm")
        page.click("#tab-components")
        self.assertEqual(self.column("branches"), ["1", "1", "1", "3"])
        page.click("#row-2 .only")
        self.assertEqual(page.text("#count-components"), "4")

    def skeletonize_labels(self, *words):
        done = harness.bccskel("labels", self.path("labels.npy"), "-o", self.path("s.html"), *words)
        self.assertEqual(done.returncode, 0, done.stderr)  # it warns of a cavity, or of nothing left

    def test_labels_are_colored_listed_and_hidden_with_their_glass(self):
        huge = 2**64 - 1
        image = numpy.zeros((14, 30, 80), "<u8")
        image[2:7, 3:8, 3:37] = image[2:7, 8:25, 18:23] = 3
        image[2:7, 12:17, 3:15] = 12
        image[2:7, 12:17, 26:44] = image[2:7, 12:17, 50:75] = huge  # two components
        image[1:13, 18:29, 50:75] = 5
        image[4:10, 21:26, 53:72] = 0  # a closed surface
        numpy.save(self.path("labels.npy"), image)
        self.skeletonize_labels("-o", self.path("s.csv"))
        page = self.open("#off=nodes")
        self.assertIn("4 labels", page.text("#points"))
        self.assertEqual(page.run("document.getElementById('color').value"), "label")
        self.assertTrue(page.run("document.getElementById('ramp').hidden"))
        page.click("#tab-components")
        self.assertIn("Labels", page.text("#tab-components"))
        self.assertEqual(page.text("#count-components"), "4")
        self.assertEqual(self.column("label"), ["3", "5", "12", str(huge)])
        triangles = page.run("data.layers[0].parts")
        whole = page.picture()
        page.click("#row-2 .only")
        page.settle()
        self.assertEqual(page.text("#count-components"), "1 of 4")
        self.assertEqual(page.run("layers[0].drawRange.count"), 3 * triangles[2])
        self.assertEqual(page.run("sheets.geometry.drawRange.count"), 0)
        self.assertNotEqual(page.picture(), whole)
        page.click("#row-2 .only")
        page.settle()
        self.assertEqual(page.run("layers[0].drawRange.count"), 3 * sum(triangles))
        self.assertGreater(page.run("sheets.geometry.drawRange.count"), 300)
        self.assertEqual(page.run("""new Set(Array.from({ length: sheets.geometry.attributes.color.count },
            (_, n) => sheets.geometry.attributes.color.getX(n))).size"""), 1)
        colors = page.run("""[...result.edges.keys()].map((id) =>
            [partName(edgePart(id)), edgeColor(id).getHexString()])""")
        self.assertEqual(len({color for _, color in colors}), len({label for label, _ in colors}))
        page.click("#tab-branches")
        self.assertIn(str(huge), self.column("label"))
        with open(self.path("s.csv"), newline="", encoding="utf-8") as file:
            theirs = list(csv.DictReader(file))
        mine = list(csv.DictReader(io.StringIO(page.run("branchCsv()"))))
        for name in ("label", "branch_id", "node_id_src", "node_id_dst", "branch_type"):
            self.assertEqual([row[name] for row in mine], [row[name] for row in theirs])

    def test_a_label_without_a_skeleton_is_listed_and_hidden(self):
        image = numpy.zeros((8, 8, 60), "u1")
        image[2:6, 2:6, 2:20] = 3
        image[4, 4, 28] = 5
        image[2:6, 2:6, 36:58] = 9
        numpy.save(self.path("labels.npy"), image)
        self.skeletonize_labels("--min-component", "30")
        page = self.open("#")
        self.assertIn("3 labels", page.text("#points"))
        self.assertTrue(page.run("document.querySelector('#keys .of-object').hidden"))
        page.click("#tab-components")
        self.assertEqual(self.column("label"), ["3", "5", "9"])
        self.assertEqual(self.column("branches"), ["1", "0", "1"])
        self.assertEqual(self.column("max")[1], "")
        triangles = page.run("data.layers[0].parts")
        self.assertGreater(min(triangles), 0)
        page.click("#row-2 .only")
        page.settle()
        self.assertEqual(page.run("layers[0].drawRange.count"), 3 * triangles[2])

    def test_the_table_joins_branches_as_pruning_does(self):
        page = self.open_sample(view_samples.forest(2))
        page.click("#dock-toggle")
        self.slide("prune", 1)
        self.assertEqual(self.column("id"), ["0", "3", "4", "5"])
        rows = list(csv.DictReader(io.StringIO(page.run("branchCsv()"))))
        self.assertEqual([float(rows[0][name]) for name in (
            "branch_type", "branch_distance", "euclidean_distance", "tortuosity", "mean_radius",
            "min_radius", "max_radius")], [0, 8, 8, 1, 13 / 9, 1, 2])
        self.assertEqual({rows[0]["node_id_src"], rows[0]["node_id_dst"]}, {"1", "2"})


class ViewpointTest(PageTestCase):
    def seen(self):
        """The direction in the world from what is seen to the viewer."""
        return self.browser.run("""[8, 9, 10].map((n) => Math.round(
            1e6 * camera.matrixWorld.elements[n]) / 1e6 + 0)""")

    def test_one_slice_is_seen_as_programs_show_the_image(self):
        mask = numpy.zeros((1, 30, 40), "u1")
        mask[0, 10:16, 5:35] = 1
        numpy.save(self.path("mask.npy"), mask)
        self.succeed("skeletonize", self.path("mask.npy"), "--local", "--border", "continues", "-o",
                     self.path("s.html"))
        self.browser.open(self.path("s.html"))
        axes = self.browser.run("""[0, 1, 2, 4, 5, 6, 8, 9, 10].map((n) => Math.round(
            camera.matrixWorld.elements[n]) + 0)""")
        self.assertEqual(axes, [1, 0, 0, 0, -1, 0, 0, 0, -1])

    def test_a_plate_does_not_show_its_edge(self):
        z, y, x = numpy.indices((60, 60, 60)) - 30
        for slope in (-1, 1):
            with self.subTest(slope):
                plate = (abs(z - slope * x) < 4) & (abs(x) < 22) & (abs(y) < 22)
                numpy.save(self.path("mask.npy"), plate)
                done = harness.bccskel("skeletonize", self.path("mask.npy"), "--local", "-o",
                                       self.path("s.html"))
                self.assertEqual(done.returncode, 0, done.stderr)  # which may warn of the plate
                self.browser.open(self.path("s.html"))
                seen = self.seen()
                self.assertGreater(abs(seen[2] - slope * seen[0]), 1.1)

    def test_buttons_and_keys_look_along_the_axes(self):
        page = self.open_sample(view_samples.forest(30))
        for axis, name in enumerate("xyz"):
            for sign, text in ((1, "+"), (-1, "-")):
                toward = [sign if n == axis else 0 for n in range(3)]
                page.click(f'[data-look="{text}{name}"]')
                page.settle()
                self.assertEqual(self.seen(), toward)
                page.click("#reset")
                page.settle()
                self.assertNotIn(1, list(map(abs, self.seen())))
                page.key(name, modifiers=0 if sign > 0 else browser.SHIFT)
                page.settle()
                self.assertEqual(self.seen(), toward)

    def test_motion_takes_a_moment_unless_it_is_not_wanted(self):
        page = self.open_sample(view_samples.forest(3))
        for wish, at_once in (("reduce", True), ("no-preference", False)):
            page.prefer(reduced_motion=wish)
            page.click("#reset")
            page.settle()
            frames = page.run("""new Promise((done) => {
              let frames = 0;
              lookAlong(0, 1);
              const count = () => {
                ++frames;
                gliding ? requestAnimationFrame(count) : done(frames);
              };
              requestAnimationFrame(count);
            })""")
            self.assertEqual(frames == 1, at_once)

    def test_scrolling_keeps_what_is_under_the_pointer(self):
        page = self.open_sample(view_samples.forest(3))
        page.click('[data-look="+z"]')
        page.settle()
        before, distance = self.place(3), page.run("view.distance")
        page.scroll(*before, -300)
        page.settle()
        after = self.place(3)
        self.assertLess(page.run("view.distance"), 0.9 * distance)
        for a, b in zip(before, after):
            self.assertAlmostEqual(a, b, delta=1)

    def test_the_cut_hides_one_side_of_the_object_and_of_the_skeleton(self):
        page = self.open_sample(view_samples.forest(3))  # the trees lie at x = 0, 12 and 24
        page.click("#cut-x")
        self.slide("cut-place", 0.5)
        self.assertEqual(page.text("#cut-at"), "x = 12 mm")
        whole = page.picture()
        page.move(*self.place(7))
        page.settle()
        self.assertEqual(page.text("#tip b"), "branch 7")  # the skeleton is whole
        page.click("#cut-all")
        page.settle()
        halves = {whole, page.picture()}
        for edge, seen in ((1, True), (7, False)):
            page.move(*EMPTY)
            page.move(*self.place(edge))
            page.settle()
            self.assertEqual(page.run("!document.getElementById('tip').hidden"), seen)
        page.click("#cut-flip")
        page.move(*EMPTY)
        page.move(*self.place(7))
        page.settle()
        self.assertEqual(page.text("#tip b"), "branch 7")
        page.move(*EMPTY)
        page.settle()
        halves.add(page.picture())
        self.assertEqual(len(halves), 3)
        page.click("#cut-off")
        self.assertEqual(page.text("#cut-at"), "")

    def test_a_link_restores_the_view(self):
        page = self.open_sample(view_samples.forest(4))
        page.click("#dock-toggle")
        page.click("#row-5")
        page.click("#tab-components")
        page.click("#row-3")
        self.slide("prune", 1)
        page.click("#flat")
        page.click("#cut-y")
        page.click("#cut-flip")
        page.click("#show-nodes")
        page.click("#theme")
        page.settle()
        page.click("#copy-link")
        page.wait("!document.getElementById('toast').hidden")
        address = page.run("location.href")
        state = page.run("[view, pins, cut, [...hidden], shown.edges]")
        seen = page.run("camera.projectionMatrix.toArray().concat(camera.matrixWorld.toArray())")
        page.send("Page.navigate", url="about:blank")
        self.open("#" + urllib.parse.urlsplit(address).fragment)
        page.click("#dock-toggle")  # the size of the picture is none of the link's
        page.settle()
        self.assertEqual(page.run("[pins, cut, [...hidden], shown.edges]"), state[1:])
        again = page.run("camera.projectionMatrix.toArray().concat(camera.matrixWorld.toArray())")
        for a, b in zip(seen, again):
            self.assertAlmostEqual(a, b, delta=2e-3)
        self.assertFalse(page.run("document.getElementById('show-nodes').checked"))
        self.assertEqual(page.run("document.documentElement.dataset.theme"), "dark")
        page.run("location.hash = ''")  # a link to the page as it opens, in the same window
        page.wait("pins.length === 0 && hidden.size === 0 && !view.flat")

    def test_a_link_that_nobody_made_does_no_harm(self):
        self.open_sample(view_samples.forest(2),
                         "#view=1_x&pins=99.-1.a&cut=q_7&hide=77&prune=zz&color=no")
        self.assertEqual(self.browser.text("#counts"), "8 nodes, 6 branches, length 20 mm")
        self.assertEqual(self.browser.run("[pins, cut.axis]"), [[], None])


if __name__ == "__main__":
    harness.main()
