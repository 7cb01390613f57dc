"""What a user does, from start to end."""

import hashlib
import json
import os
import pty
import subprocess
import time

import harness


class CommandsTest(harness.TestCase):
    def test_a_client_reaches_a_server_that_starts_after_it(self):
        volume = self.generate("ball", 5000)
        for name, words in (("one-call", ("skeletonize", volume, "-o", self.path("late.json"))),
                            ("durable", ("submit", volume, "--detach"))):
            with self.subTest(name):
                client = subprocess.Popen(
                    [harness.CLIENT, *words, "--server", f"unix:{self.folder}/{name}"],
                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                time.sleep(0.1)
                with harness.Server(self.folder, "--data-dir", self.path("data"), name=name):
                    _, said = client.communicate(timeout=300)
                self.assertEqual(client.returncode, 0, said)

    def test_examples_of_the_help_run_as_printed(self):
        corners = ((0, 0, 0), (10, 0, 0), (0, 10, 0), (0, 0, 10))
        with open(self.path("model.stl"), "w") as file:
            file.write("solid model\n")
            for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
                file.write("facet normal 0 0 0\nouter loop\n")
                for n in face:
                    file.write("vertex {} {} {}\n".format(*corners[n]))
                file.write("endloop\nendfacet\n")
            file.write("endsolid model\n")
        header = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 30 9 9\nencoding: raw\n\n"
        for name in ("scan", "cells"):
            self.write(name + ".nrrd", header + (bytes(5) + bytes([3]) * 20 + bytes(5)) * 81)
        for command in ("generate", "skeletonize", "labels", "info", "view", "render", "convert",
                        "reconstruct", "voxelize"):
            lines = self.succeed(command, "--help").split("\nExamples:\n")[1].split("\n\n")[0]
            for line in lines.split("\n"):
                self.assertTrue(line.startswith(f"  bccskel {command} "), line)
                done = subprocess.run(f'"{harness.CLIENT}"' + line.replace("  bccskel", "", 1),
                                      shell=True, cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, line + "\n" + done.stderr)

    def test_voxelize_submit_and_all_outputs(self):
        mesh, volume = self.tetrahedron("tetrahedron.off", 10, 10, 10), self.path("v.exr")
        text = self.succeed("voxelize", mesh, "--points", 20000, "-o", volume)
        self.assertIn("4 vertices, 4 triangles, watertight, genus 0", text)
        self.assertIn("written:     " + volume, text)
        endings = "swc vtp graphml obj csv glb mrk.json json exr bccb svg png html".split()
        outputs = harness.outputs(self.path("s." + e) for e in endings)
        with harness.Server(self.folder) as server:
            text = self.succeed("submit", volume, "--server", server.address, *outputs)
        self.assertIn("topology kept", text)
        self.assertIn(f" s on {server.address}, of which", text)
        for ending in endings:
            self.assertIn("written:   " + self.path("s." + ending), text)
            self.assertGreater(os.path.getsize(self.path("s." + ending)), 100)

    def test_server_and_this_machine_give_the_same_over_any_transport_and_threads(self):
        mesh = self.tetrahedron("tetrahedron.off", 10, 10, 10)
        volumes = [self.generate(shape, 30000, shape + ".bccb") for shape in ("tree", "knot")]
        with harness.Server(self.folder) as unix, \
             harness.Server(self.folder, name="second", listen="127.0.0.1:0") as loopback:
            for source in [mesh, *volumes]:
                runs = [self.run_json(source, *place) for place in (
                    ("--local", "--threads", 1), ("--local", "--threads", 3),
                    ("--server", unix.address, "--threads", 2),
                    ("--server", loopback.address))]
                for other in runs[1:]:
                    self.assertEqual(other, runs[0])

    def run_json(self, source, *place):
        """The summary of one run, and a digest of each of its files (to compare long ones fast)."""
        endings = ("json", "swc", "vtp", "graphml", "csv", "glb", "bccb", "svg", "png", "html")
        outputs = harness.outputs(self.path("run." + e) for e in endings)
        grid = ("--points", 20000) if source.endswith(".off") else ()
        summary = json.loads(self.succeed("skeletonize", source, "--json", *grid, *place, *outputs))
        files = {e: (self.folder / ("run." + e)).read_bytes() for e in endings}
        document = harness.without_times(json.loads(files["json"]))
        self.assertEqual(document["sha256"], summary["sha256"])
        files["json"] = json.dumps(document).encode()
        digests = {e: hashlib.sha256(content).hexdigest() for e, content in files.items()}
        return harness.without_times(summary), digests

    def test_the_summary_tells_the_method_and_counts_in_words(self):
        volume = self.generate("ball", 5000)
        command = ("skeletonize", volume, "--local", "-o", self.path("s.json"), "--method",
                   "directional", "--distance", "chamfer")
        self.assertIn("method:    curve skeleton by parallel directional thinning on the "
                      "body-centered cubic grid by chamfer shells\n", self.succeed(*command))
        summary = self.summarize(*command)
        self.assertEqual((summary["method"], summary["kind"], summary["distance"]),
                         ("directional", "curve", "chamfer"))
        options = self.read_json("s.json")["options"]
        self.assertEqual((options["pruning"], options["pruning_threshold"]), ("significance", 0.45))
        kernel = ("skeletonize", volume, "--local", "-o", self.path("s.json"), "--kind", "kernel")
        self.assertIn("skeleton:  1 point, 1 component, 0 loops, 0 cavities, 1 node, 0 edges\n",
                      self.succeed(*kernel))
        options = self.read_json("s.json")["options"]
        self.assertEqual((options["pruning"], options["tips"]), ("none", "as-thinned"))

    def test_a_node_that_is_not_there_is_a_wrong_command_line(self):
        volume = self.generate("ball", 5000)
        self.fail_with(2, "root node 999: the skeleton has ", "skeletonize", volume, "--local",
                       "-o", self.path("s.swc"), "--root", "node:999")

    def test_a_root_far_from_the_skeleton_is_warned_of(self):
        volume, far = self.generate("ball", 5000), ("--root", "1e6,0,0")
        outside = ": the root is far from the skeleton, "
        done = harness.bccskel("skeletonize", volume, "--local", "-o", self.path("s.json"), *far)
        self.assertEqual(done.returncode, 0)
        self.assertIn(volume + outside, done.stderr)
        done = harness.bccskel("convert", self.path("s.json"), "-o", self.path("s.swc"), *far)
        self.assertIn(self.path("s.json") + outside, done.stderr)

    def test_submit_takes_what_skeletonize_takes_of_volumes(self):
        volume = self.generate("torus")
        with harness.Server(self.folder) as server:
            command = ("--server", server.address, "-o", self.path("a.json"), "--json")
            submitted = json.loads(self.succeed("submit", volume, *command))
            skeletonized = json.loads(self.succeed("skeletonize", volume, *command))
        self.assertEqual(harness.without_times(submitted), harness.without_times(skeletonized))
        self.assertEqual(submitted["certificate"]["skeleton"],
                         {"components": 1, "loops": 1, "cavities": 0})

    def test_a_skeleton_written_as_a_volume_is_its_own_skeleton(self):
        volume, thin = self.generate("tree"), self.path("thin.exr")
        first = json.loads(self.succeed("skeletonize", volume, "--local", "--json", "-o", thin))
        info = json.loads(self.succeed("info", thin, "--json"))
        self.assertEqual(info["volume"]["points"], first["skeleton_points"])
        self.assertEqual(info["volume"]["topology"], first["certificate"]["skeleton"])

    def test_info_describes_meshes_and_volumes(self):
        mesh = json.loads(self.succeed("info", self.tetrahedron("a.off"), "--json"))
        self.assertEqual(mesh["kind"], "mesh")
        self.assertEqual(mesh["mesh"]["genus"], 0)
        self.assertTrue(mesh["mesh"]["watertight"])
        self.assertEqual(mesh["mesh"]["crossings"], 0)
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]

        def info(points, faces):
            lines = ["OFF", f"{len(points)} {len(faces)} 0"]
            lines += [" ".join(map(str, point)) for point in points]
            lines += ["3 " + " ".join(map(str, face)) for face in faces]
            return self.succeed("info", self.write("b.off", "\n".join(lines) + "\n"))
        corners = [(0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)]
        self.assertIn("; 4 present from both sides)",
                      info(corners, faces + [face[::-1] for face in faces]))
        needle = [(1, 1, -3), (2, 1, -3), (1, 2, -3), (1, 1, 4)]
        self.assertIn("crossings:   3 pairs of triangles\n",
                      info(corners + needle, faces + [[n + 4 for n in face] for face in faces]))
        volume = json.loads(self.succeed("info", self.generate("hollow-ball"), "--json"))
        self.assertEqual(volume["volume"]["topology"],
                         {"components": 1, "loops": 0, "cavities": 1})

    def test_options_change_the_result_in_the_same_way_everywhere(self):
        volume = self.generate("tree")
        with harness.Server(self.folder) as server:
            digests = set()
            for options in ((), ("--stubble", "none"), ("--shell-width", 3), ("--last-shell", 2),
                            ("--no-cleanup",), ("--method", "directional-alternating"),
                            ("--method", "symmetric"),
                            ("--method", "symmetric", "--kind", "kernel")):
                local, remote = (
                    self.summarize("skeletonize", volume, *options, *place, "-o",
                                   self.path("a.swc"))
                    for place in (("--local",), ("--server", server.address)))
                self.assertEqual(harness.without_times(local), harness.without_times(remote))
                digests.add(local["sha256"])
        self.assertGreaterEqual(len(digests), 5)

    def test_a_pipe_gets_no_progress_unless_it_is_asked_for(self):
        command = ("skeletonize", self.generate("tree"), "--local", "-o", self.path("a.swc"))
        self.succeed(*command)  # checks that standard error is empty
        done = harness.bccskel(*command, "--progress", "always")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"shell 1/\d+ .* points removed, .* left")
        self.assertTrue(done.stderr.startswith("reading "), done.stderr)
        self.assertNotIn("\r", done.stderr)

    def test_every_command_that_can_take_long_tells_a_log_what_it_does(self):
        volume, result = self.generate("tree"), self.path("a.json")
        reading = "reading " + os.path.basename(volume)
        self.succeed("skeletonize", volume, "--local", "-o", result)
        for words, phases in (
                (("view", result, "--object", volume, "-o", self.path("a.html")),
                 ["reading a.json", reading, "peeling the object for the page",
                  "writing a.html"]),
                (("render", result, "--object", volume, "-o", self.path("a.png")),
                 ["reading a.json"]),
                (("convert", result, "-o", self.path("b.csv")), ["reading a.json", "writing b.csv"]),
                (("info", volume), [reading]),
                (("voxelize", self.tetrahedron("a.off"), "--points", "1000", "-o",
                  self.path("b.exr")), ["reading a.off"]),
                (("generate", "torus", "--points", "5000", "-o", self.path("c.exr")),
                 ["making the shape", "writing c.exr"])):
            with self.subTest(words[0]):
                done = harness.bccskel(*words, "--progress", "always")
                self.assertEqual(done.returncode, 0, done.stderr)
                lines = done.stderr.splitlines()
                self.assertEqual([line for line in phases if line not in lines], [], lines)

    def test_a_mesh_becomes_850000_points_unless_another_size_is_given(self):
        summary = json.loads(self.succeed("voxelize", self.tetrahedron("a.off"), "--json", "-o",
                                          self.path("a.exr")))
        self.assertAlmostEqual(summary["volume"]["points"], 850_000, delta=10_000)
        for command, default in (("voxelize", "(default 850000)\n"),
                                 ("skeletonize", "(default 850000)\n"),
                                 ("view", "(default: as for the result)\n")):
            self.assertIn(default, self.succeed(command, "--help"))

    def test_a_terminal_gets_a_bar_that_ends_in_a_clean_line(self):
        volume = self.generate("tree")
        shown = self.on_terminal("skeletonize", volume, "--local", "-o", self.path("a.swc"))
        self.assertIn("\r[", shown)
        self.assertTrue(shown.endswith("\n"))
        silent = self.on_terminal("skeletonize", volume, "--local", "-o", self.path("a.swc"),
                                  "--progress", "never")
        self.assertEqual(silent, "")

    def test_a_terminal_shows_what_takes_long(self):
        result, pipe = self.path("a.json"), self.path("pipe.csv")
        self.succeed("skeletonize", self.generate("tree"), "--local", "-o", result)
        os.mkfifo(pipe)
        ours, theirs = self.terminal()
        with open(ours, "rb", buffering=0) as screen:
            client = subprocess.Popen([harness.CLIENT, "convert", result, "-o", pipe],
                                      stderr=theirs, stdout=subprocess.DEVNULL)
            os.close(theirs)
            shown = b""
            while b"writing pipe.csv" not in shown:  # it waits for a reader
                shown += screen.read(65536)
            with open(pipe, "rb") as reader:
                reader.read()
            self.assertEqual(client.wait(timeout=300), 0)

    def terminal(self):
        """Our end and the command's end."""
        try:
            return pty.openpty()
        except OSError as error:
            self.skipTest(f"no pseudo-terminals (is /dev/pts mounted?): {error}")

    def on_terminal(self, *words):
        """What a command shows on a terminal that is its standard error."""
        ours, theirs = self.terminal()
        with open(ours, "rb", buffering=0) as screen:
            subprocess.run([harness.CLIENT, *words], stderr=theirs, stdout=subprocess.PIPE,
                           timeout=300, check=True)
            os.close(theirs)
            shown = b""
            try:
                while piece := screen.read(65536):
                    shown += piece
            except OSError:  # the way a terminal says that it ends
                pass
        return shown.decode()

    def test_names_may_hold_blanks_quotes_and_bytes_that_are_not_utf8(self):
        volume = self.generate("ball", name="a \"b\" é.bccb")
        output = os.fsencode(self.path("s ")) + b"\xff.json"
        done = subprocess.run([harness.CLIENT, "skeletonize", volume, "--local", "--json", "-o",
                               output], capture_output=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["input"], volume)
        self.assertTrue(os.path.exists(output))


if __name__ == "__main__":
    harness.main()
