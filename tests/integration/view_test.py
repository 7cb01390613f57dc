"""Pages that `bccskel view` makes, opened in a browser."""

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
        self.succeed("skeletonize", volume, "--local", "-o", self.path("s.json"))
        summary = json.loads(self.succeed("view", self.path("s.json"), "--object", volume,
                                          "-o", self.path("s.html"), "--json"))
        self.assertEqual(summary["bytes"], os.path.getsize(self.path("s.html")))
        return summary

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
        for address in ("", "#peel=2", "#theme=dark"):
            self.browse("--screenshot=" + self.path("s.png"), address=address)
            pictures.append((self.folder / "s.png").read_bytes())
        self.assertEqual(len(set(pictures)), 3)
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
