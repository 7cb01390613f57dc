"""Every exit code that --help and the man page promise, reached in the way a user reaches it."""

import json
import os
import pathlib
import signal
import subprocess
import threading
import unittest
from concurrent import futures

import grpc

import harness


class ExitCodesTest(harness.TestCase):
    def skeletonize(self, source, *words):
        return ("skeletonize", source, "-o", self.path("out.swc"), *words)

    def start(self, *words):
        return subprocess.Popen([harness.CLIENT, *map(str, words)], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def long_job(self):
        """A volume that takes seconds to thin on one thread."""
        return self.generate("tree", 16_000_000)

    def test_2_for_a_wrong_command_line(self):
        self.fail_with(2, "--output is required", "skeletonize", "a.off")
        for name, shown in (("out", "out"), ("", "an empty name"), ("b.d/out", "b.d/out")):
            self.fail_with(2, f"{shown}: an output needs an ending, which selects its format: .swc, ",
                           "skeletonize", "a.off", "-o", name)

    def test_3_for_an_input_that_cannot_be_read_or_is_something_else(self):
        self.fail_with(3, "No such file", *self.skeletonize(self.path("none.off"), "--local"))
        self.fail_with(3, "No such file", *self.skeletonize(self.path("none.exr"), "--local"))
        for name in ("a.off", "a.exr", "a.bccb", "a.stl.gz"):
            file = self.write(name, "nonsense " * 20)
            self.fail_with(3, name, *self.skeletonize(file, "--local"))
            self.fail_with(3, name, "info", file)
        for name in ("a.docx", "a.xlsx"):
            done = self.fail_with(3, "format not supported",
                                  *self.skeletonize(self.write(name, ""), "--local"))
            self.assertIn("; save another image as NIfTI or NRRD, which keep its place, or as TIFF, PNG or .npy\n", done.stderr)
        self.fail_with(3, "cannot open 'none': No such file", *self.skeletonize("none", "--local"))
        self.fail_with(3, "cannot open 'none': No such file", "info", "none")
        self.fail_with(3, "No such file", *self.skeletonize("a.nrrd", "--local"))
        self.fail_with(3, "submit takes volumes", "submit", "a.off", "-o", self.path("a.swc"))
        self.fail_with(3, "is a volume already", "voxelize", "a.exr", "-o", "b.exr")

    def test_4_for_no_server(self):
        done = self.fail_with(4, "server unix:/nowhere", *self.skeletonize(
            self.generate("ball"), "--server", "unix:/nowhere"))
        self.assertIn("bccskel: hint: start bccskel-server", done.stderr)

    def test_4_tells_what_to_do(self):
        start = "bccskel: hint: start bccskel-server, or name another server with --server\n"
        for words in (["probe"], ["jobs"], ["top", "--once"], ["watch", "1"], ["cancel", "1"],
                      ["delete", "1"], ["fetch", "1", "-o", self.path("out.swc")]):
            done = self.fail_with(4, "server unix:/nowhere", *words, "--server", "unix:/nowhere")
            self.assertTrue(done.stderr.endswith(start), done.stderr)
        volume = self.generate("ball")
        for words, here in ((self.skeletonize(volume), "--local"),
                            (("submit", volume, "-o", self.path("a.swc")), "bccskel skeletonize"),
                            (("submit", volume, "--detach"), "bccskel skeletonize")):
            done = self.fail_with(4, "nowhere", *words, "--server", "unix:/nowhere")
            self.assertIn(f"another server with --server, or compute here with {here}\n", done.stderr)

    def test_5_when_the_deadline_passes(self):
        volume = self.long_job()
        self.fail_with(5, "not done within the 0.001 s of --timeout", *self.skeletonize(volume, "--local", "--timeout", 0.001))
        with harness.Server(self.folder) as server:
            done = self.fail_with(5, "deadline", *self.skeletonize(
                volume, "--server", server.address, "--timeout", 0.01))
            # In the client's words or, if it notices first, in the server's.
            self.assertRegex(done.stderr, "the deadline passed before|the job's deadline has passed")
        self.assert_no_output()

    def test_6_for_a_server_that_ends_without_a_result(self):
        class Liar(grpc.GenericRpcHandler):
            def service(self, _):
                return grpc.stream_stream_rpc_method_handler(lambda requests, context: iter(()))

        liar = grpc.server(futures.ThreadPoolExecutor(2), handlers=[Liar()])
        liar.add_insecure_port("unix:" + self.path("liar"))
        liar.start()
        self.fail_with(6, "without a summary", *self.skeletonize(
            self.generate("ball"), "--server", "unix:" + self.path("liar")))
        liar.stop(None).wait()

    def test_7_over_a_limit_of_the_server_or_of_this_machine(self):
        volume = self.generate("tree", 100_000)
        with harness.Server(self.folder, "--max-bricks", "10") as server:
            self.fail_with(7, "10", *self.skeletonize(volume, "--server", server.address))
        self.fail_with(7, "the limit is", *self.skeletonize(
            self.tetrahedron("far.off", z="1e9"), "--local", "--spacing", 0.01))

    @unittest.skipIf(harness.SANITIZED, "sanitizers reserve memory of their own")
    def test_7_when_memory_runs_out(self):
        done = self.fail_with(7, "not enough memory\nbccskel: hint: a mesh needs less with",
                              *self.skeletonize(self.tetrahedron("a.off"), "--local"), "--points",
                              "4G", preexec_fn=harness.limit_memory(1))
        self.assertNotIn("bad_alloc", done.stderr)

    def test_8_when_output_cannot_be_written(self):
        volume = self.generate("ball")
        missing = f": the folder {self.path('no/such/folder')} does not exist; create it first"
        for ending in ("swc", "exr", "bccb", "svg"):
            output = self.path("no/such/folder/a." + ending)
            self.fail_with(8, output + missing, "skeletonize", volume, "--local", "-o", output)
        self.fail_with(8, "a.exr", "voxelize", self.tetrahedron("a.off"), "--points", 9999, "-o",
                       self.path("no/a.exr"))
        self.fail_with(8, "a.exr", "generate", "ball", "-o", self.path("no/a.exr"))
        for words in (("info", volume), ("--help",), ("--version",), ("info", "--help")):
            with open("/dev/full", "w") as full:
                done = subprocess.run([harness.CLIENT, *words], stdout=full, timeout=60,
                                      stderr=subprocess.PIPE, text=True)
            self.assertEqual((done.returncode, done.stderr),
                             (8, "bccskel: error: cannot write to standard output\n"), words)

    def test_8_comes_before_the_work(self):
        good, bad = self.path("a.swc"), self.path("no/b.swc")
        for words in (("skeletonize", "missing.off", "--local", "-o", good, "-o", bad),
                      ("labels", "missing.tif", "-o", self.path("no/{label}.swc")),
                      ("skeletonize", "missing.nrrd", "--local", "-o", good,
                       "--branch-image", self.path("no/b.nrrd"))):
            self.fail_with(8, "cannot write " + self.path("no/"), *words)
        self.assertEqual(os.listdir(self.folder), [])

    def test_8_for_one_file_leaves_the_others(self):
        full = self.path("full.svg")
        os.symlink("/dev/full", full)
        done = self.fail_with(8, f"cannot write {full}: No space left", "skeletonize",
                              self.generate("tree"), "--local", "--json", "-o", self.path("a.swc"),
                              "-o", full, "-o", self.path("b.csv"))
        self.assertEqual([os.path.basename(file["path"]) for file in json.loads(done.stdout)["outputs"]],
                         ["a.swc", "b.csv"])
        self.assertTrue(pathlib.Path(self.path("b.csv")).read_text().startswith("skeleton_id,"))

    def test_130_and_143_while_a_pipe_has_no_reader(self):
        volume, pipe = self.generate("tree"), self.path("pipe.swc")
        os.mkfifo(pipe)
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            client = self.start("skeletonize", volume, "--local", "--progress", "always", "-o", pipe)
            while "writing pipe.swc" not in client.stderr.readline():
                self.assertIsNone(client.poll())
            client.send_signal(number)
            try:
                _, error = client.communicate(timeout=60)
            finally:
                client.kill()
            self.assertEqual(client.returncode, code, error)
            self.assertIn("pipe.swc: interrupted, so it was not written", error)

    def test_130_while_files_are_written(self):
        volume = self.generate("tree", 2_000_000)
        self.interrupted_writing("pipe.json", "skeletonize", volume, "--local", "-o",
                                 self.path("pipe.json"), "-o", self.path("out.swc"))
        self.assert_no_output()

    def interrupted_writing(self, pipe, *words):
        """Interrupts a command while it writes to a pipe; returns its messages."""
        os.mkfifo(self.path(pipe))
        client = self.start(*words)
        with open(self.path(pipe), "rb") as reader:
            reader.read(1)  # it writes
            harness.interrupt(client)
            reader.read()
        _, error = client.communicate(timeout=300)
        self.assertEqual(client.returncode, 130, error)
        os.unlink(self.path(pipe))
        return error

    def test_130_leaves_the_old_files_and_no_drafts(self):
        result = self.path("tree.json")
        self.succeed("skeletonize", self.generate("tree", 500_000), "--local", "-o", result)
        old = pathlib.Path(self.write("old.graphml", "old"))
        folder = pathlib.Path(self.path("old.precomputed"))
        self.succeed("convert", result, "-o", folder)
        before = (folder / "1").read_bytes()
        files = sorted(os.listdir(self.folder))
        error = self.interrupted_writing("pipe.vtp", "convert", result, "-o", self.path("pipe.vtp"),
                                         "-o", old, "-o", folder, "-o", self.path("new.precomputed"))
        self.assertIn(": interrupted, so it was not written", error)
        self.interrupted_writing("pipe.html", "view", result, "-o", self.path("pipe.html"))
        self.interrupted_writing("pipe.svg", "render", result, "-o", self.path("pipe.svg"))
        self.assertEqual(sorted(os.listdir(self.folder)), files)
        self.assertEqual(old.read_text(), "old")
        self.assertEqual((folder / "1").read_bytes(), before)
        self.assertEqual(sorted(os.listdir(folder)), ["1", "info"])

    def test_130_leaves_whole_files_of_labels(self):
        sides = 40
        voxels = bytearray(sides ** 3)
        for at in range(len(voxels)):
            x, y = at % sides, at // sides % sides
            if x % 4 < 2 and y % 4 < 2:
                voxels[at] = 1 + x // 4 + sides // 4 * (y // 4)
        image = self.write("labels.nrrd", b"NRRD0004\ntype: uint8\ndimension: 3\n"
                           b"sizes: 40 40 40\nencoding: raw\n\n" + voxels)
        all_labels = self.write("all.vtp", "old")
        self.interrupted_writing("label-1.json", "labels", image, "--local", "-o",
                                 self.path("label-{label}.json"), "-o", all_labels)
        for name in os.listdir(self.folder):
            if name.startswith("label-"):
                self.assertRegex(name, r"^label-[0-9]+\.json$")
                self.read_json(name)
        self.assertEqual(pathlib.Path(all_labels).read_text(), "old")

    def test_without_a_place_it_computes_here_and_the_summary_says_so(self):
        self.assertIn(" s on this machine, of which",
                      self.succeed(*self.skeletonize(self.generate("ball"))))

    def test_9_for_a_token_that_is_missing_or_wrong(self):
        tokens, token = pathlib.Path(self.path("tokens")), pathlib.Path(self.path("token"))
        tokens.write_text("acme " + "0" * 64 + "\n")
        token.write_text("bccskel_wrong\n")
        words = self.skeletonize(self.generate("ball"), "--server")
        with harness.Server(self.folder, "--tokens", tokens) as server:
            self.fail_with(9, "token", *words, server.address)
            self.fail_with(9, "token", *words, server.address, "--token-file", token)
            token.write_text("secr\u00e9t\n")
            done = self.fail_with(3, "its first line is not a token", *words, server.address,
                                  "--token-file", token)
            self.assertNotIn("secr", done.stderr)

    def test_3_for_tls_files_that_hold_no_pem(self):
        words = self.skeletonize(self.generate("ball"), "--server", "localhost:1", "--tls-ca")
        # Empty, it would turn TLS off.
        for text, message in (("", "ca.pem: is empty"), ("text", "authorities is not PEM")):
            self.fail_with(3, message, *words, self.write("ca.pem", text))

    def test_3_for_a_tls_file_that_is_missing_without_blame_on_the_server(self):
        done = self.fail_with(3, "cannot open", "probe", "--server", "localhost:1", "--tls-ca",
                              self.path("nix.pem"))
        self.assertNotIn("server localhost", done.stderr)

    def test_3_for_a_folder_in_place_of_a_token(self):
        self.fail_with(3, "is a folder", "probe", "--server", "localhost:1", "--token-file",
                       self.folder)

    def await_shell(self, client):
        """Until the client has told its first shell: it computes."""
        for line in client.stderr:
            if "shell 1/" in line:
                return
        self.fail("ended before its first shell")

    def test_130_and_143_cancel_the_job_on_the_server(self):
        volume = self.long_job()
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with harness.Server(self.folder, name=f"server{code}") as server:
                client = self.start(*self.skeletonize(volume, "--server", server.address,
                                                      "--threads", 1, "--progress", "always"))
                self.await_shell(client)
                client.send_signal(number)
                _, error = client.communicate(timeout=300)
                self.assertEqual(client.returncode, code, error)
                ended = server.wait_for_log("event", "call ended")
                self.assertEqual(ended["code"], "CANCELLED")
        self.assert_no_output()

    def test_130_on_this_machine(self):
        client = self.start(*self.skeletonize(self.long_job(), "--local", "--threads", 1,
                                              "--progress", "always"))
        self.await_shell(client)
        client.send_signal(signal.SIGINT)
        _, error = client.communicate(timeout=300)
        self.assertEqual(client.returncode, 130, error)
        self.assertTrue(error.endswith("object.bccb: interrupted\n"), error)
        self.assert_no_output()

    def test_130_while_it_waits_for_a_server(self):
        client = self.start(*self.skeletonize(self.generate("ball"), "--server", "unix:/nowhere"))
        harness.interrupt(client)
        client.communicate(timeout=300)
        self.assertEqual(client.returncode, 130)

    def test_130_while_a_server_does_not_answer(self):
        calls = threading.Semaphore(0)

        def answer_late(context):
            calls.release()
            ended = threading.Event()
            context.add_callback(ended.set)
            ended.wait(60)

        class Late(grpc.GenericRpcHandler):
            def service(self, details):
                return grpc.unary_unary_rpc_method_handler(
                    lambda request, context: answer_late(context))

        server = grpc.server(futures.ThreadPoolExecutor(4), handlers=(Late(),))
        port = server.add_insecure_port("127.0.0.1:0")
        server.start()
        self.addCleanup(server.stop, None)
        for words in (("probe", "--timeout", 300), ("jobs",), ("cancel", "jobs/x"),
                      ("top", "--once")):
            with self.subTest(words):
                client = self.start(*words, "--server", f"127.0.0.1:{port}")
                self.assertTrue(calls.acquire(timeout=60))
                client.send_signal(signal.SIGINT)
                _, error = client.communicate(timeout=30)
                self.assertEqual(client.returncode, 130, error)

    def test_a_closed_pipe_does_not_kill(self):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([harness.CLIENT, "info", self.generate("ball")], stdout=writer,
                              stderr=subprocess.PIPE, text=True, timeout=60)
        os.close(writer)
        self.assertEqual(done.returncode, 8, done.stderr)

    def test_0_though_a_process_of_the_same_number_left_a_draft(self):
        command = 'touch "$1".part$$.0 && exec "$0" generate ball --points 6000 -o "$1"'
        done = subprocess.run(["bash", "-c", command, harness.CLIENT, self.path("out.exr")],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_0_leaves_no_draft_behind(self):
        volume = self.generate("ball")
        self.succeed(*self.skeletonize(volume, "--local"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["object.bccb", "out.swc"])
        json.loads(self.succeed(*self.skeletonize(volume, "--local", "--json")))

    def assert_no_output(self):
        left = [n for n in os.listdir(self.folder) if n.startswith("out.swc")]
        self.assertEqual(left, [])


if __name__ == "__main__":
    harness.main()
