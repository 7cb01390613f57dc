"""Docstrings and the Python blocks of the package's README run as they stand."""

import contextlib
import doctest
import io
import os
import pathlib
import re

import bccskel
import harness
from bccskel import _compute, _skeleton

README = harness.SOURCES / "client/python/README.md"


class DocumentsTest(harness.TestCase):
    def test_docstrings(self):
        for module, least in ((bccskel, 4), (_compute, 15), (_skeleton, 12)):
            failed, attempted = doctest.testmod(module)
            self.assertEqual(failed, 0)
            self.assertGreaterEqual(attempted, least)

    def test_the_readme(self):
        blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
        self.assertGreaterEqual(len(blocks), 5)
        folder = pathlib.Path.cwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, folder)
        for block in blocks:
            with self.subTest(block), contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, str(README), "exec"), {})


if __name__ == "__main__":
    harness.main()
