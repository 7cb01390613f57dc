"""Several servers on one PostgreSQL database and one folder."""

import concurrent.futures
import functools
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import grpc

import postgres_process
import server_process
from durable_case import JobCalls, large_requests, large_volume, upload_requests, volume
from interface import (CallTest, Code, durable, example, jobs, service_grpc, shell_width,
                       torus_loops, volumes)
from server_process import ServerProcess

POSTGRES = None  # of all tests, each of which has a database of its own


def setUpModule():
    global POSTGRES
    if postgres_process.programs():
        POSTGRES = postgres_process.PostgresProcess()
        unittest.addModuleCleanup(POSTGRES.close)


@functools.cache
def slow_volume():
    """A few seconds of one thread, so that a server can be ended meanwhile."""
    return volume(400.0, 130.0)


class Server(JobCalls):
    """One of the fleet, and calls to it."""

    def __init__(self, test, process):
        self.process = process
        self.connect(test, process)

    def send(self, declaration, data):
        return durable.send_volume(self.channel, declaration, data)

    def wait_for(self, job, state):
        for event in self.jobs.WatchJob(jobs.WatchJobRequest(job=job)):
            if event.HasField("state_change") and event.state_change.state == state:
                return

    def signal(self, number):
        self.process.process.send_signal(number)

    def warnings(self, text):
        return self.process.log_text().count(text)


@unittest.skipUnless(postgres_process.programs(), "PostgreSQL (package postgresql) is not installed")
class FleetTest(CallTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data = pathlib.Path(folder.name) / "data"
        self.postgres = POSTGRES
        self.postgres.make("jobs")

    def process(self, *flags):
        return ServerProcess("--data-dir", str(self.data), "--job-store", self.postgres.url,
                             "--threads", "1", *flags)

    def start(self, number=2, *flags):
        """All at the same time: one of them makes the tables."""
        with concurrent.futures.ThreadPoolExecutor(number) as pool:
            processes = list(pool.map(lambda _: self.process(*flags), range(number)))
        return [Server(self, process) for process in processes]

    def owner_of(self, job):
        return self.postgres.ask(f"SELECT owner FROM jobs WHERE name = '{job}'")


class AnyServerTest(FleetTest):
    def test_a_job_is_made_here_watched_there_and_read_anywhere(self):
        servers = self.start(3)
        name = servers[0].send(*volume())
        job = servers[1].create(name).name
        self.assertEqual(servers[2].finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        expected = example.skeletonize(servers[0].channel, example.torus()).summary.sha256
        for server in servers:
            self.assertEqual(durable.read_skeleton(server.channel, job).summary.sha256, expected)
            self.assertEqual([found.name for found in server.jobs.ListJobs(
                jobs.ListJobsRequest()).jobs], [job])
        servers[2].jobs.DeleteJob(jobs.DeleteJobRequest(job=job))
        self.fails(Code.NOT_FOUND, "NOT_FOUND", lambda: servers[0].get(job))

    def test_progress_reaches_who_watches_on_any_server(self):
        servers = self.start()
        job = servers[0].create(servers[0].send(*slow_volume())).name
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            watches = [pool.submit(lambda server=server: list(durable.watch(server.channel, job)))
                       for server in servers]
        for watch in watches:
            shells = [event.shell_progress.shell for event in watch.result()
                      if event.HasField("shell_progress")]
            self.assertGreater(len(shells), 1)
            self.assertEqual(shells, sorted(shells))
            numbers = [event.sequence for event in watch.result()
                       if not event.HasField("heartbeat")]
            self.assertEqual(numbers, sorted(set(numbers)))

    def test_a_job_is_cancelled_on_a_server_that_does_not_run_it(self):
        first, second = self.start()
        name = first.send(*slow_volume())
        job = first.create(name).name
        first.wait_for(job, jobs.JOB_STATE_RUNNING)
        watch = threading.Thread(target=first.finish, args=(job,))
        watch.start()
        for server in (second, first):  # one of them runs it, the other does not
            found = server.jobs.CancelJob(jobs.CancelJobRequest(job=job)).job
            self.assertEqual(found.state, jobs.JOB_STATE_CANCELLED)
        watch.join()
        self.assertEqual(second.finish(job)[-1], jobs.JOB_STATE_CANCELLED)
        # The thread that ran it is free for another.
        after = second.create(second.send(*volume())).name
        self.assertEqual(first.finish(after)[-1], jobs.JOB_STATE_SUCCEEDED)

    def test_who_watches_a_job_that_is_deleted_elsewhere_hears_its_end(self):
        first, second = self.start()
        job = first.create(first.send(*slow_volume())).name
        first.wait_for(job, jobs.JOB_STATE_RUNNING)
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            heard = pool.submit(first.finish, job)
            second.jobs.DeleteJob(jobs.DeleteJobRequest(job=job))
            try:
                self.assertEqual(heard.result()[-1], jobs.JOB_STATE_CANCELLED)
            except grpc.RpcError as error:  # it was gone before the watch began
                self.assertEqual(error.code(), Code.NOT_FOUND)

    def test_one_request_id_makes_one_job_however_many_ask_whomever(self):
        servers = self.start()
        name = servers[0].send(*volume())
        with concurrent.futures.ThreadPoolExecutor(50) as pool:
            made = {job.name for job in pool.map(
                lambda n: servers[n % 2].create(name, "once"), range(100))}
        self.assertEqual(len(made), 1)
        self.fails(Code.ALREADY_EXISTS, "REQUEST_ID_REUSED", lambda: servers[1].create(
            name, "once", priority=jobs.JOB_PRIORITY_HIGH))

    def test_equal_work_runs_once(self):
        servers = self.start(3)
        name = servers[0].send(*large_volume())
        made = [server.create(name).name for server in servers for _ in range(2)]
        for job in made:
            self.assertEqual(servers[0].finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.assertEqual(len(list(self.data.glob("tenants/*/results/*"))), 1)
        ran = self.postgres.ask("SELECT count(DISTINCT owner) FROM jobs WHERE attempts > 0")
        self.assertLessEqual(int(ran), 1)

    def test_servers_share_what_waits(self):
        servers = self.start(3)
        name = servers[0].send(*large_volume())
        made = [servers[0].create(name, options=shell_width(1 + n / 64)).name for n in range(12)]
        for job in made:
            self.assertEqual(servers[1].finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        for _ in range(250):  # the log is written by a thread of its own
            ran = [server for server in servers if server.warnings('"state":"RUNNING"')]
            if len(ran) > 1:
                return
            time.sleep(0.02)
        self.fail(f"{len(ran)} of 3 servers ran 12 jobs")


class UploadTest(FleetTest):
    def test_an_upload_that_was_begun_here_goes_on_there(self):
        first, second = self.start()
        declaration, data = large_volume()
        half = len(data) // 2

        def send(server, begin, end):
            server.volumes.UploadVolume(upload_requests(
                "uploads/mine", declaration, data[:end], begin, finish=end == len(data)))

        def committed(server):
            return server.volumes.GetUploadStatus(volumes.GetUploadStatusRequest(
                upload="uploads/mine")).upload.committed_size

        send(first, 0, half)
        self.assertEqual((committed(first), committed(second)), (half, half))
        third = half + len(data) // 4
        send(second, half, third)
        self.assertEqual((committed(first), committed(second)), (third, third))
        send(first, third, len(data))
        upload = second.volumes.GetUploadStatus(volumes.GetUploadStatusRequest(
            upload="uploads/mine")).upload
        self.assertTrue(upload.volume)
        self.assertEqual(len(list(self.data.glob("tenants/*/uploads/*"))), 0)
        job = second.create(upload.volume).name
        self.assertEqual(first.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)

    def test_a_quota_holds_for_all_servers_together(self):
        declaration, data = large_volume()
        first, second = self.start(2, "--max-tenant-disk-bytes", str(int(len(data) * 1.5)))
        first.send(declaration, data)
        declaration.placement.origin[0] += 1  # another volume
        self.addCleanup(lambda: declaration.placement.origin.__setitem__(0, 0))
        self.fails(Code.RESOURCE_EXHAUSTED, "DISK_FULL", lambda: second.send(declaration, data))


class LossTest(FleetTest):
    def running_on(self, servers):
        """A slow job, the server that runs it, and the other one."""
        job = servers[0].create(servers[0].send(*slow_volume())).name
        servers[0].wait_for(job, jobs.JOB_STATE_RUNNING)
        while True:  # the log is written by a thread of its own
            for runner, other in (servers, reversed(servers)):
                if runner.warnings('"state":"RUNNING"'):
                    return job, runner, other
            time.sleep(0.02)

    def test_jobs_of_a_killed_server_go_on_elsewhere(self):
        first, second = self.start()
        job, runner, other = self.running_on((first, second))
        runner.process.stop(signal.SIGKILL)
        self.assertEqual(other.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.assertEqual(other.get(job).attempts, 2)
        self.assertTrue(durable.read_skeleton(other.channel, job).summary.sha256)

    def test_a_server_that_hangs_is_fenced_off_and_comes_back(self):
        first, second = self.start()
        job, stopped, other = self.running_on((first, second))
        owner = self.owner_of(job)
        stopped.signal(signal.SIGSTOP)
        while self.owner_of(job) == owner:
            time.sleep(0.1)
        while self.postgres.ask("SELECT count(*) FROM servers") != "1":
            time.sleep(0.1)
        stopped.signal(signal.SIGCONT)
        self.assertEqual(other.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        while self.postgres.ask("SELECT count(*) FROM servers") != "2":
            time.sleep(0.1)
        self.assertEqual(stopped.get(job).state, jobs.JOB_STATE_SUCCEEDED)
        self.assertEqual(stopped.warnings("silent for too long"), 1)
        after = stopped.create(stopped.send(*volume())).name
        self.assertEqual(stopped.finish(after)[-1], jobs.JOB_STATE_SUCCEEDED)
        # One result each, and nothing that the fenced-off server has left.
        while len(list(self.data.glob("tenants/*/results/*"))) != 2:
            time.sleep(0.1)

    def test_the_database_may_be_away(self):
        first, second = self.start()
        name = first.send(*large_volume())
        made = [first.create(name, f"request-{n}", options=shell_width(1 + n / 64)).name for n in range(6)]
        self.postgres.stop()
        self.fails(Code.UNAVAILABLE, "UNAVAILABLE", lambda: second.create(name, "later"))
        self.assertEqual(torus_loops(second.channel), 1)  # nothing durable
        self.postgres.start()
        while True:
            try:
                later = second.create(name, "later").name
                break
            except grpc.RpcError as error:
                self.assertEqual(error.code(), Code.UNAVAILABLE)
                time.sleep(0.02)
        for job in [*made, later]:
            self.assertEqual(second.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        self.assertEqual([first.create(name, f"request-{n}", options=shell_width(1 + n / 64)).name
                          for n in range(6)], made)
        self.assertEqual(first.warnings("silent") + second.warnings("silent"), 0)

    def test_a_one_call_job_goes_on_where_its_server_was_killed(self):
        first, second = self.start()
        replies = service_grpc.SkeletonizationServiceStub(first.channel).Skeletonize(
            large_requests())
        job = next(replies).accepted.job
        while second.get(job).state == jobs.JOB_STATE_RECEIVING:
            time.sleep(0.01)
        first.process.stop(signal.SIGKILL)
        self.assertEqual(second.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)


class StartTest(FleetTest):
    def refused(self, *flags):
        run = server_process.run_to_end("--listen", "127.0.0.1:0", *flags)
        self.assertNotEqual(run.returncode, 0)
        return run.stderr

    def test_a_folder_is_shared_by_servers_of_one_database_only(self):
        self.start(1)
        self.assertIn("another server owns", self.refused("--data-dir", str(self.data)))
        self.assertIn("belongs to another job store", self.refused(
            "--data-dir", str(self.data), "--job-store", self.postgres.make("other")))

    def test_an_older_server_refuses_the_tables_of_a_newer_one(self):
        self.start(1)[0].process.stop()
        self.postgres.ask("UPDATE store SET version = 999")
        self.assertIn("999", self.refused("--data-dir", str(self.data), "--job-store",
                                          self.postgres.url))

    def test_a_password_in_the_url_and_a_missing_folder_are_refused(self):
        self.assertIn("PGPASSFILE", self.refused("--data-dir", str(self.data), "--job-store",
                                                 "postgresql://me:secret@localhost/jobs"))
        self.assertIn("--data-dir", self.refused("--job-store", self.postgres.url))


if __name__ == "__main__":
    unittest.main(verbosity=2)
