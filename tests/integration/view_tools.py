"""What tests of the tools of a page share."""

from view_test import PageTestCase


class ToolsTestCase(PageTestCase):
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
