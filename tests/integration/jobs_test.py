"""Jobs that a server keeps, as a user of the command line has them."""

import json
import pathlib
import subprocess

import harness
import numpy
from harness import CLIENT, Server


class JobsTest(harness.TestCase):
    def server(self, name="server"):
        return Server(self.folder, "--data-dir", self.path("data"), "--threads", "1", name=name)

    def submit_file(self, server, volume, *more):
        return self.succeed("submit", volume, "--detach", "--server", server.address, *more).strip()

    def submit(self, server, *more, points=20000, shape="torus"):
        return self.submit_file(server, self.generate(shape, points), *more)

    def submit_waiting(self, server, first_width=1):
        """A job behind others, new to the server, that keep its one thread for seconds."""
        large = self.generate("torus", 8_000_000, "large.bccb")
        small = self.generate("torus")
        for n in range(8):
            self.submit_file(server, large, "--shell-width", first_width + n / 8)
        return self.submit_file(server, small)

    def jobs(self, server):
        listed = self.succeed("jobs", "--json", "--server", server.address)
        return {job["job"]: job for job in json.loads(listed)["jobs"]}

    def test_a_detached_job_is_watched_fetched_and_deleted(self):
        with self.server() as server:
            job = self.submit(server)
            self.assertTrue(job.startswith("jobs/"), job)
            self.assertEqual(self.succeed("watch", job, "--server", server.address),
                             f"{job} succeeded\n")
            fetch = ("fetch", job, "--server", server.address, "-o", self.path("f.json"))
            self.assertEqual(self.succeed(*fetch), f"written:   {self.path('f.json')}\n")
            self.assertEqual(
                json.loads(self.succeed(*fetch, "--json")),
                {"job": job, "outputs": [{"path": self.path("f.json"), "note": ""}]})
            shown = harness.bccskel(*fetch, "--object", self.path("object.bccb"),
                                    "--progress", "always").stderr.splitlines()
            self.assertEqual((shown[0], shown[-1]), ("reading object.bccb", "writing f.json"))
            self.succeed("skeletonize", self.path("object.bccb"), "--local", "--json",
                         "-o", self.path("l.json"))
            self.assertEqual(self.read_json("f.json")["sha256"], self.read_json("l.json")["sha256"])
            self.assertEqual(self.jobs(server)[job]["state"], "succeeded")
            self.assertIn(job, self.succeed("jobs", "--server", server.address))
            self.succeed("delete", job, "--server", server.address)
            self.assertEqual(self.jobs(server), {})
            self.fail_with(3, "server", "watch", job, "--server", server.address)

    def test_an_object_without_points_has_a_result_without_any(self):
        numpy.save(self.path("nothing.npy"), numpy.zeros((4, 5, 6)))
        nothing = self.path("nothing.exr")
        harness.bccskel("voxelize", self.path("nothing.npy"), "-o", nothing)
        with self.server() as server:
            job = self.submit_file(server, nothing)
            self.assertEqual(self.succeed("watch", job, "--server", server.address),
                             f"{job} succeeded\n")
            self.succeed("fetch", job, "--server", server.address, "-o", self.path("there.json"))
        harness.bccskel("skeletonize", nothing, "--local", "-o", self.path("here.json"))
        there, here = self.read_json("there.json"), self.read_json("here.json")
        self.assertEqual((there["nodes"], there["sha256"]), ([], here["sha256"]))

    def test_a_result_is_fetched_in_every_format(self):
        endings = ("json", "graphml", "vtp", "swc", "csv", "glb", "obj", "svg", "png", "html")
        with self.server() as server:
            job = self.submit(server, shape="horse")  # no loop, which SWC cannot hold
            local, fetched = ([self.path(f"{which}.{ending}") for ending in endings]
                              for which in ("local", "fetched"))
            self.succeed("skeletonize", self.path("object.bccb"), "--local",
                         *harness.outputs(local))
            self.succeed("fetch", job, "--server", server.address, "--object",
                         self.path("object.bccb"),
                         *harness.outputs(fetched))
            for mine, theirs in zip(local, fetched):
                if not mine.endswith((".json", ".html")):  # those say how long it took
                    self.assertEqual(pathlib.Path(mine).read_bytes(),
                                     pathlib.Path(theirs).read_bytes(), mine)
            self.assertIn("<html", pathlib.Path(fetched[-1]).read_text())

    def test_the_thinned_volume_of_a_detached_job_is_fetched_where_it_was_asked_for(self):
        with self.server() as server:
            job = self.submit(server, "--thin-volume")
            for ending in ("bccb", "exr"):
                local, fetched = self.path(f"local.{ending}"), self.path(f"fetched.{ending}")
                self.succeed("skeletonize", self.path("object.bccb"), "--local", "-o", local)
                self.succeed("fetch", job, "--server", server.address, "-o", fetched)
                self.assertEqual(pathlib.Path(local).read_bytes(),
                                 pathlib.Path(fetched).read_bytes())

    def test_fetch_says_what_it_cannot_write(self):
        with self.server() as server:
            job = self.submit(server)
            fetch = ("fetch", job, "--server", server.address)
            self.fail_with(2, "no output format has this ending", *fetch, "-o", self.path("a.txt"))
            self.fail_with(2, "--object", *fetch, "-o", self.path("a.html"))
            self.fail_with(2, "ends in .exr or .bccb", *fetch, "-o", self.path("a.json"),
                           "--object", self.path("a.stl"))
            self.fail_with(3, "--thin-volume keeps it", *fetch, "-o", self.path("a.exr"))
            other = self.path("other.bccb")
            self.succeed("generate", "ball", "--points", "5000", "-o", other)
            self.fail_with(3, "points; the volume of", *fetch, "-o", self.path("a.svg"),
                           "--object", other)

    def test_a_job_outlives_the_server(self):
        with self.server() as server:
            job = self.submit(server, points=2_000_000)
            server.process.kill()
            server.process.wait()
        with self.server("second") as server:
            self.succeed("fetch", job, "--server", server.address, "-o", self.path("a.vtp"))
            self.assertEqual(self.jobs(server)[job]["state"], "succeeded")

    def test_ctrl_c_cancels_a_job_that_is_waited_for_unless_detached(self):
        for detached in (False, True):
            with self.server() as server:
                job = self.submit_waiting(server, 2 if detached else 1)
                waiting = subprocess.Popen(
                    [CLIENT, "watch", job, "--server", server.address,
                     "--progress", "always", *(["--detach"] if detached else [])],
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                harness.interrupt(waiting)
                self.assertEqual(waiting.wait(timeout=300), 130)
                state = self.jobs(server)[job]["state"]
                self.assertEqual(state == "cancelled", not detached, state)

    def test_cancel_ends_a_job(self):
        with self.server() as server:
            job = self.submit_waiting(server)
            self.assertEqual(self.succeed("cancel", job, "--server", server.address),
                             f"{job} cancelled\n")
            self.fail_with(5, "cancelled", "fetch", job, "--server", server.address,
                           "-o", self.path("a.json"))

    def test_cancel_says_that_a_job_had_ended_before(self):
        with self.server() as server:
            job = self.submit(server)
            self.succeed("watch", job, "--server", server.address)
            self.assertEqual(self.succeed("cancel", job, "--server", server.address),
                             f"{job} had ended before: succeeded\n")

    def test_wrong_words_are_told(self):
        volume = self.generate("torus")
        self.fail_with(2, "--output is required", "submit", volume)
        self.fail_with(2, "--detach writes no files", "submit", volume, "--detach",
                       "-o", self.path("a.json"))
        self.fail_with(2, "--thin-volume is for --detach", "submit", volume, "--thin-volume",
                       "-o", self.path("a.json"))
        with Server(self.folder) as server:
            self.fail_with(3, "--data-dir", "submit", volume, "--detach",
                           "--server", server.address)
            self.fail_with(3, "--data-dir", "jobs", "--server", server.address)

    def test_a_call_goes_on_after_the_server_was_killed(self):
        listen = f"unix:{self.folder}/socket"
        flags = ("--data-dir", self.path("data"), "--threads", "1")
        volume = self.path("large.exr")
        self.succeed("generate", "torus", "--points", 12_000_000, "-o", volume)
        with Server(self.folder, *flags, name="first", listen=listen) as server:
            calling = subprocess.Popen(
                [CLIENT, "submit", volume, "--server", listen, "-o", self.path("a.json")],
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            # Only a client that has heard the job's name, and so sent its volume, goes on with it.
            server.wait_for_log("state", "RUNNING")
            server.process.kill()
            server.process.wait()
        with Server(self.folder, *flags, name="second", listen=listen) as server:
            _, error = calling.communicate(timeout=240)
            self.assertEqual(calling.returncode, 0, error)
            [name] = self.jobs(server)
            self.assertIn("warning: lost the connection to " + listen, error)
            self.assertIn("to go on with " + name, error)
            self.assertEqual([job["attempts"] >= 1 for job in self.jobs(server).values()], [True])


if __name__ == "__main__":
    harness.main()
