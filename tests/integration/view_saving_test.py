"""What a page of `bccskel view` saves, and how often it draws."""

import csv
import struct

import harness
import view_samples
from view_test import PageTestCase


class SavingTest(PageTestCase):
    def saved(self, button, ending):
        downloads = self.folder / "downloads"
        self.browser.send("Browser.setDownloadBehavior", session=None, behavior="allow",
                          downloadPath=str(downloads))
        for old in downloads.glob("*"):
            old.unlink()
        self.browser.click(button)
        # Chromium holds the name with an empty file, and writes to one that ends otherwise.
        def saved():
            return [p for p in downloads.glob("*" + ending) if p.stat().st_size > 0]
        harness.wait_until(saved, "a file was saved")
        return saved()[0]

    def test_the_csv_is_that_of_the_command_line(self):
        volume = self.generate("tree", 20000)
        for root in ((), ("--root", "thickest-end")):
            self.succeed("skeletonize", volume, "--local", *root, "-o", self.path("s.html"),
                         "-o", self.path("s.csv"))
            self.open()
            path = self.saved("#save-csv", ".csv")
            ours = list(csv.reader(path.read_text().splitlines()))
            theirs = list(csv.reader((self.folder / "s.csv").read_text().splitlines()))
            self.assertEqual(ours[0], theirs[0])
            self.assertEqual(len(ours), len(theirs))
            for a, b in zip(ours[1:], theirs[1:]):
                for name, mine, other in zip(ours[0], a, b):
                    self.assertEqual(mine == "", other == "", name)
                    if name in ("world", "unit"):
                        self.assertEqual((mine, other), ("unknown", "unknown"), name)
                    elif mine:
                        self.assertAlmostEqual(float(mine), float(other),
                                               delta=1e-12 * abs(float(other)))

    def test_the_csv_lists_what_the_table_lists(self):
        self.open_sample(view_samples.forest(3))
        self.browser.click("#search")
        self.browser.type("length<3")
        rows = list(csv.DictReader(self.saved("#save-csv", ".csv").read_text().splitlines()))
        self.assertEqual([row["branch_id"] for row in rows], ["2", "5", "8"])

    def test_pictures_are_as_large_as_the_canvas_or_twice_that(self):
        self.browser.resize(1200, 800, scale=1)
        page = self.open_sample(view_samples.forest(3))
        width, height = page.run("[stage.clientWidth, stage.clientHeight]")
        for button, ratio in (("#save-1x", 1), ("#save-2x", 2)):
            data = self.saved(button, ".png").read_bytes()
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack(">II", data[16:24]), (ratio * width, ratio * height))
            self.assertGreater(len(data), 5000 * ratio)  # a blank one is smaller
        page.picture()
        self.assertEqual(page.run("[canvas.width, canvas.height]"), [width, height])


class FramesTest(PageTestCase):
    def test_nothing_is_drawn_while_nothing_moves_and_few_calls_draw_thousands(self):
        page = self.open_sample(view_samples.forest(1700, columns=40))
        page.settle()
        page.wait("!gliding && !asked && !pace.coarse")
        frames = """(() => { window.frames_ = 0; const ask = requestAnimationFrame;
          window.requestAnimationFrame = (act) => { ++frames_; return ask(act); }; })()"""
        page.run(frames)
        page.run("new Promise((done) => setTimeout(done, 500))")
        self.assertEqual(page.run("frames_"), 0)
        page.key("ArrowLeft")
        page.settle()
        self.assertGreater(page.run("frames_"), 0)
        self.assertLess(page.run("renderer.info.render.calls"), 12)


if __name__ == "__main__":
    harness.main()
