#!/usr/bin/python3
"""Measures the frames of a page while its object turns.

Usage:
  PYTHONPATH=build/release/client/python tests/bench/page_report.py [PAGE.html ...]

Without pages, that of a net of 4,752 branches. Prints draw calls and triangles per frame, the time
that the page's scripts take for one, and the frames per second. Needs chromium, which draws here
without a graphics card, so the frames per second are far fewer than users see; and python3-numpy.
"""

import argparse
import pathlib
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "integration"))

from browser import Browser
from formats_report import net_of

LINES = 12

FRAMES = """new Promise((done) => {
  const frames = 60, scripts = [];
  let begin = 0;
  function next(n) {
    requestAnimationFrame((now) => {
      if (n === 0) begin = now;
      if (n === frames) {
        scripts.sort((a, b) => a - b);
        done({ edges: result.edges.length, calls: renderer.info.render.calls,
               triangles: renderer.info.render.triangles,
               script: scripts[frames >> 1], rate: 1000 * frames / (now - begin) });
        return;
      }
      view.turn += 0.05;
      const start = performance.now();
      draw(1);
      scripts.push(performance.now() - start);
      next(n + 1);
    });
  }
  next(0);
})"""


def report_of(browser, path):
    browser.open(path)
    browser.settle()
    frame = browser.run(FRAMES)
    print(f"| {path.name} | {frame['edges']:,} | {frame['calls']} | {frame['triangles']:,} | "
          f"{frame['script']:.1f} | {frame['rate']:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("pages", metavar="PAGE.html", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| page | branches | draw calls | triangles | ms of scripts | frames per second |\n"
          "|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder, Browser() as browser:
        browser.resize(1200, 800, 1)
        pages = arguments.pages
        if not pages:
            import bccskel  # not needed for pages that are there
            pages = [pathlib.Path(folder) / "net.html"]
            bccskel.skeletonize(net_of(LINES)).save(pages[0])
        for page in pages:
            report_of(browser, page.resolve())


if __name__ == "__main__":
    main()
