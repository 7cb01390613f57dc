"""Pages that `bccskel view` and `-o x.html` make, opened in a browser."""

import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

import harness

CHROMIUM = shutil.which("chromium")


def number(text):
    return float(text.replace(",", ""))


@unittest.skipIf(CHROMIUM is None, "chromium is not installed")
class ViewTest(harness.TestCase):
    def page(self, shape, points=20000):
        volume = self.generate(shape, points)
        done = harness.bccskel("skeletonize", volume, "--local", "-o", self.path("s.json"))
        self.assertEqual(done.returncode, 0, done.stderr)  # which may warn of cavities
        summary = json.loads(self.succeed("view", self.path("s.json"), "--object", volume,
                                          "-o", self.path("s.html"), "--json"))
        self.assertEqual(summary["bytes"], os.path.getsize(self.path("s.html")))
        return summary

    def test_the_skeleton_alone_is_shown(self):
        self.page("tree")
        self.succeed("view", self.path("s.json"), "-o", self.path("s.html"))
        shown = self.browse("--dump-dom")
        self.assertEqual(re.search('data-state="([a-z]+)"', shown)[1], "ready")
        self.assertRegex(shown, '<div class="of-object" hidden="">')

    def test_skeletonize_writes_the_page_with_the_shells_as_they_were_taken(self):
        volume = self.generate("tree", 20000)
        self.succeed("skeletonize", volume, "--local", "-o", self.path("s.html"))
        shown = self.browse("--dump-dom", address="#peel=1")
        self.assertEqual(re.search('data-state="([a-z]+)"', shown)[1], "ready")
        self.assertRegex(shown, r'<output id="shells">\d+ of \d+ shells off<')

    def branches(self, nodes, edges):
        """How many branches edges are, where junctions of two edges are no junctions."""
        parts = [{number} for number in range(len(edges))]
        for node, about in enumerate(nodes):
            here = [n for n, e in enumerate(edges) for end in ("source", "target")
                    if e[end] == node]
            if about["kind"] == "junction" and len(here) == 2:
                joined = parts[here[0]] | parts[here[1]]
                for number in joined:
                    parts[number] = joined
        return len({min(part) for part in parts})

    def test_pruning_hides_branches_and_counts_the_rest(self):
        self.page("tree")
        document = json.loads((self.folder / "s.json").read_text())
        edges = document["edges"]
        levels = sorted({e["pruning_level"] for e in edges if "pruning_level" in e})
        self.assertGreater(len(levels), 10)
        for step in (5, len(levels)):
            left = [e for e in edges
                    if "pruning_level" not in e or e["pruning_level"] not in levels[:step]]
            count = self.branches(document["nodes"], left)
            self.assertLess(count, len(left))
            shown = self.browse("--dump-dom", address=f"#prune={step}")
            self.assertRegex(shown, rf'<p id="counts"[^>]*>\d+ nodes?, {count} branch')

    def browse(self, *options, address=""):
        """What the browser prints; it finds no network and draws without a graphics card."""
        done = subprocess.run(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND",
             "--user-data-dir=" + self.path("profile"), "--window-size=1000,700",
             "--virtual-time-budget=60000", "--enable-logging=stderr", "--log-level=0", *options,
             "file://" + self.path("s.html") + address],
            capture_output=True, text=True, timeout=120)
        self.assertEqual(re.findall(r".*CONSOLE.*", done.stderr), [])
        return done.stdout

    def test_every_kind_of_object_is_shown_without_a_complaint(self):
        for shape in ("tree", "hollow-ball"):
            with self.subTest(shape=shape):
                self.page(shape)
                shown = self.browse("--dump-dom")
                self.assertEqual(re.search('data-state="([a-z]+)"', shown)[1], "ready")
                self.assertRegex(shown, '<p id="verdict"[^>]*>\u2713 topology kept</p>')
                told = re.search('<tbody id="certificate">(.*?)</tbody>', shown)[1]
                cavities = 1 if shape == "hollow-ball" else 0
                self.assertEqual(re.sub("<[^>]*>", " ", told).split(),
                                 f"components 1 1 loops 0 0 cavities {cavities} {cavities}".split())

    def test_the_peeled_object_is_seen(self):
        self.page("tree", 200000)
        pictures = []
        for address in ("", "#peel=2", "#theme=dark", "#prune=20"):
            pictures.append(self.picture(address))
        self.assertEqual(len(set(pictures)), 4)
        for picture in pictures:
            self.assertGreater(len(picture), 30000)  # a blank page is smaller

    def probe(self):
        """What a page says to somebody who points at things and changes the colors."""
        page = self.folder / "s.html"
        probe = pathlib.Path(__file__).with_name("view_probe.js").read_text()
        page.write_text(page.read_text().replace("</body>", f"<script>{probe}</script></body>"))
        heard = re.search(r'data-heard="([^"]*)"', self.browse("--dump-dom"))
        return json.loads(html.unescape(heard[1]))

    def test_pointing_at_a_branch_tells_its_figures(self):
        self.page("tree", 5000)
        heard = self.probe()
        result = json.loads((self.folder / "s.json").read_text())
        branches = {name: rows for name, rows in heard["figures"].items()
                    if name.startswith("branch ")}
        self.assertGreater(len(branches), len(result["edges"]) // 2)
        self.assertTrue(any(name.startswith("end ") for name in heard["figures"]))
        for name, rows in branches.items():
            edge = result["edges"][int(name.split()[1])]
            self.assertAlmostEqual(number(rows["length"]), edge["length"],
                                   delta=0.01 * edge["length"])
            least, most = map(number, re.search(r"\((.*) to (.*)\)", rows["radius here"]).groups())
            self.assertAlmostEqual(least, min(edge["radii"]), delta=0.01 * most)
            self.assertAlmostEqual(most, max(edge["radii"]), delta=0.01 * most)
        self.assertTrue(heard["away"])  # nothing is told where nothing is

    def test_the_choice_of_colors_changes_the_legend_and_the_picture(self):
        self.page("tree", 5000)
        self.assertNotEqual(self.picture("#color=radius"), self.picture("#color=branch"))
        colors = {name: (least, hidden) for name, least, hidden in self.probe()["colors"]}
        self.assertEqual(set(colors), {"by radius", "by branch", "by length", "by pruning level"})
        self.assertRegex(colors["by length"][0], r"^length \d")
        self.assertRegex(colors["by radius"][0], r"^radius \d")
        self.assertEqual([name for name, (_, hidden) in colors.items() if hidden], ["by branch"])

    def picture(self, address):
        self.browse("--screenshot=" + self.path("s.png"), address=address)
        return (self.folder / "s.png").read_bytes()

    def test_a_surface_skeleton_is_seen_as_a_sheet(self):
        volume = self.generate("box")
        pictures = set()
        for kind in ("surface", "curve"):
            self.succeed("skeletonize", volume, "--local", "--kind", kind, "-o", self.path("s.html"))
            pictures.add(self.picture(""))
        shown = self.browse("--dump-dom")
        self.assertEqual(re.search('data-state="([a-z]+)"', shown)[1], "ready")
        self.assertEqual(len(pictures), 2)


if __name__ == "__main__":
    harness.main()
