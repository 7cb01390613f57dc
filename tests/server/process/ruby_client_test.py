"""A caller in Ruby, where Debian's ruby-grpc is installed: the interface needs no code of ours."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

from server_process import SOURCE, TIMEOUT_S, ServerProcess

RUBY, PLUGIN = shutil.which("ruby", path="/usr/bin"), shutil.which("grpc_ruby_plugin")
READY = bool(RUBY and PLUGIN) and subprocess.run(
    [RUBY, "-e", "require 'grpc'"], capture_output=True, check=False).returncode == 0


def ring():
    """A square ring of voxels, three wide: one loop, no end."""
    mask = np.zeros((9, 30, 30), dtype=np.uint8)
    mask[3:6, 4:26, 4:26] = 1
    mask[3:6, 7:23, 7:23] = 0
    return mask


@unittest.skipUnless(READY, "ruby-grpc and grpc_ruby_plugin are not installed")
class RubyTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        protos = sorted(map(str, (SOURCE / "proto/bccskel/v1").glob("*.proto")))
        subprocess.run([os.environ["PROTOC"], "-I", SOURCE / "proto", f"--ruby_out={self.folder}",
                        f"--grpc_out={self.folder}", f"--plugin=protoc-gen-grpc={PLUGIN}", *protos],
                       check=True)

    def run_example(self, mask, address):
        np.save(self.folder / "mask.npy", mask)
        return subprocess.run(
            [RUBY, "-I", self.folder, SOURCE / "client/examples/skeletonize.rb",
             self.folder / "mask.npy", address],
            capture_output=True, text=True, timeout=TIMEOUT_S, check=False)

    def test_it_counts_ends_and_loops(self):
        rod = np.zeros((5, 5, 40), dtype=bool)
        rod[1:4, 1:4, 2:38] = True
        with ServerProcess() as server:
            for mask, expected in ((ring(), "0 ends, 1 loops\n"), (rod, "2 ends, 0 loops\n")):
                done = self.run_example(mask, server.address)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertTrue(done.stdout.endswith(expected), done.stdout)

    def test_it_says_what_the_server_or_the_file_lacks(self):
        with ServerProcess("--max-volume-bytes", "100") as server:
            refused = self.run_example(ring(), server.address)
            self.assertIn("ResourceExhausted: the declared volume has", refused.stderr)
            wrong = self.run_example(np.zeros((3, 3)), server.address)
            self.assertIn("must be bytes or booleans with three axes", wrong.stderr)
            self.assertEqual((refused.returncode, wrong.returncode), (1, 1))


if __name__ == "__main__":
    unittest.main()
