"""Pages that `bccskel view` and `-o x.html` make, opened in a browser."""

import json
import os
import re
import shutil
import subprocess
import unittest

import harness

CHROMIUM = shutil.which("chromium")


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

    def test_pruning_hides_branches_and_counts_the_rest(self):
        self.page("tree")
        edges = json.loads((self.folder / "s.json").read_text())["edges"]
        levels = sorted({e["pruning_level"] for e in edges if "pruning_level" in e})
        self.assertGreater(len(levels), 10)
        for step in (5, len(levels)):
            left = [e for e in edges
                    if "pruning_level" not in e or e["pruning_level"] not in levels[:step]]
            shown = self.browse("--dump-dom", address=f"#prune={step}")
            self.assertRegex(shown, rf'<p id="counts"[^>]*>\d+ nodes?, {len(left)} branch')

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
                self.assertTrue("topology kept" in shown)

    def test_the_peeled_object_is_seen(self):
        self.page("tree", 200000)
        pictures = []
        for address in ("", "#peel=2", "#theme=dark", "#prune=20"):
            self.browse("--screenshot=" + self.path("s.png"), address=address)
            pictures.append((self.folder / "s.png").read_bytes())
        self.assertEqual(len(set(pictures)), 4)
        for picture in pictures:
            self.assertGreater(len(picture), 30000)  # a blank page is smaller

    def test_an_object_that_is_not_the_results_own_is_noticed(self):
        self.page("tree")
        other = self.generate("ball", 5000, "other.bccb")
        done = harness.bccskel("view", self.path("s.json"), "--object", other,
                               "-o", self.path("t.html"))
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"warning: .*other.bccb: has [\d,]+ points, but .*s.json was")


if __name__ == "__main__":
    harness.main()
