"""A server whose disk is full reports it to clients that need space and loses nothing that it confirmed."""

import contextlib
import os
import resource
import signal
import subprocess
import tempfile
import unittest

import grpc

from durable_case import DurableTest, large_volume, upload_requests, volume
from interface import Code, durable, example, jobs, shell_width, torus_loops, volumes

KIB = 1 << 10
UNLIMITED = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)


class FullTablesTest(DurableTest):
    """SQLite itself can write no more: its log has come to the limit of a file's size."""

    def fill(self, name):
        """Makes jobs until one is refused: those that were confirmed, and the refusal."""
        made = []
        while len(made) < 10_000:
            try:
                made.append(self.create(name, f"job-{len(made)}",
                                        options=shell_width(1 + len(made) / 1e4)).name)
            except grpc.RpcError as error:
                return made, error
        return self.fail("the tables were never full")

    def test_jobs_are_refused_while_the_tables_cannot_grow_and_those_confirmed_are_done(self):
        server = self.start()
        name = durable.send_volume(self.channel, *volume())
        log = self.data / "jobs.db-wal"
        limit = log.stat().st_size + 200 * KIB
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
        made, refusal = self.fill(name)
        self.assertEqual((refusal.code(), example.error_reason(refusal)),
                         (Code.RESOURCE_EXHAUSTED, "DISK_FULL"))
        self.assertTrue(refusal.details().startswith("the server's disk is full: delete"))
        print(f"{len(made)} jobs were confirmed before the tables were full")
        # It goes on: with what it knows, and with what needs no disk.
        self.assertEqual(self.get(made[-1]).name, made[-1])
        self.assertEqual(torus_loops(self.channel), 1)
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, UNLIMITED)
        for job in made:
            self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.assertTrue(self.create(name, "afterwards").name)

    def test_a_kill_while_the_tables_are_full_loses_no_confirmed_job(self):
        server = self.start()
        name = durable.send_volume(self.channel, *volume())
        limit = (self.data / "jobs.db-wal").stat().st_size + 100 * KIB
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
        made, _ = self.fill(name)
        server.stop(signal.SIGKILL)
        self.start()
        listed = {job.name for job in self.jobs.ListJobs(jobs.ListJobsRequest(page_size=1000)).jobs}
        self.assertLessEqual(set(made), listed)
        self.assertEqual(self.finish(made[-1])[-1], jobs.JOB_STATE_SUCCEEDED)


class SmallDiskTest(DurableTest):
    """A disk of 8 MiB of its own, where this may be mounted."""

    def setUp(self):
        super().setUp()
        disk = tempfile.mkdtemp()
        self.addCleanup(os.rmdir, disk)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "none", disk],
                                 capture_output=True, text=True, check=False)
        if mounted.returncode != 0:
            self.skipTest(f"no disk may be mounted here: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", "--lazy", disk], check=True)
        self.data = self.data.__class__(disk) / "data"

    def test_an_upload_that_does_not_fit_is_refused_and_the_others_go_on(self):
        self.start()
        name = durable.send_volume(self.channel, *volume())
        first = self.create(name, "first").name
        self.assertEqual(self.finish(first)[-1], jobs.JOB_STATE_SUCCEEDED)
        declaration = large_volume()[0]
        declaration = declaration.__class__.FromString(declaration.SerializeToString())
        declaration.extent.nx = declaration.extent.ny = 1024
        declaration.size_bytes = 2 * 1024 * 1024 * 4 * ((declaration.extent.nz + 31) // 32)
        error = self.fails(Code.RESOURCE_EXHAUSTED, "DISK_FULL", lambda: self.volumes.UploadVolume(
            upload_requests("uploads/large", declaration, bytes(declaration.size_bytes))))
        committed = durable.committed_size(self.volumes, "uploads/large")
        print(f"{committed} bytes of {declaration.size_bytes} fitted: {error.details()}")
        self.assertEqual(torus_loops(self.channel), 1)
        # What makes room works without room.
        self.volumes.DeleteUpload(volumes.DeleteUploadRequest(upload="uploads/large"))
        again = self.create(name, "second", options=shell_width(2)).name
        self.assertEqual(self.finish(again)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.assertTrue(durable.read_skeleton(self.channel, first).summary.sha256)

    def fill_the_disk(self):
        """To the last byte, by somebody else."""
        filler = self.data.parent / "filler"
        self.addCleanup(filler.unlink, missing_ok=True)
        with filler.open("wb", buffering=0) as file:
            for size in (1 << 16, 1 << 12, 1):
                with contextlib.suppress(OSError):
                    while True:
                        file.write(bytes(size))
        return filler

    def test_on_a_disk_without_a_byte_left_jobs_end_and_everything_can_be_deleted(self):
        self.start()
        name = durable.send_volume(self.channel, *volume())
        made = [self.create(name, f"job-{n}", options=shell_width(1 + n / 10)).name
                for n in range(10)]
        for job in made:
            self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.fill_the_disk()
        for _ in range(2):  # also after a start
            for job in made[:5]:
                self.jobs.DeleteJob(jobs.DeleteJobRequest(job=job))
            del made[:5]
            self.fill_the_disk()
            self.kill(self.server)
            self.start()
        self.volumes.DeleteVolume(volumes.DeleteVolumeRequest(volume=name))
        self.assertFalse(list(self.data.rglob("results/*")) + list(self.data.rglob("blobs/*")))
        self.assertFalse(self.jobs.ListJobs(jobs.ListJobsRequest()).jobs)

    def test_a_job_that_runs_while_the_disk_fills_ends(self):
        self.start()
        name = durable.send_volume(self.channel, *large_volume())
        made = [self.create(name, options=shell_width(1 + n / 10)).name for n in range(3)]
        self.fill_the_disk()
        for job in made:
            self.assertIn(self.finish(job)[-1], (jobs.JOB_STATE_SUCCEEDED, jobs.JOB_STATE_FAILED))
            message = self.get(job).error.message
            self.assertTrue(not message or message.startswith("the server's disk is full"), message)
            self.jobs.DeleteJob(jobs.DeleteJobRequest(job=job))

    def start(self, *flags):
        self.server = super().start(*flags)
        return self.server


if __name__ == "__main__":
    unittest.main()
