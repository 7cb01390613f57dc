"""The package beside the code that protoc generates for the interface: both are named bccskel."""

import os
import pathlib
import subprocess
import sys

import bccskel
import harness

PACKAGE = pathlib.Path(bccskel.__file__).parents[1]


class InterfaceTest(harness.TestCase):
    def test_both_are_found_in_either_order(self):
        stubs = self.folder / "stubs"
        (stubs / "bccskel" / "v1").mkdir(parents=True)
        (stubs / "bccskel" / "v1" / "volume_pb2.py").write_text("NUMBER = 7\n")
        for paths in ((stubs, PACKAGE), (PACKAGE, stubs)):
            done = subprocess.run(
                [sys.executable, "-c", "import bccskel\nfrom bccskel.v1 import volume_pb2\n"
                 "print(volume_pb2.NUMBER, bccskel.__version__)"],
                env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))},
                capture_output=True, text=True)
            self.assertEqual(done.stdout, f"7 {bccskel.__version__}\n", done.stderr)


if __name__ == "__main__":
    harness.main()
