"""A data directory that was damaged: nothing wrong is told, and nothing is deleted for it."""

import re
import shutil
import subprocess
import tempfile
import time
import unittest

import grpc
import yaml

from durable_case import DurableTest, volume
from interface import Code, durable, jobs, jobs_grpc, shell_width
from server_process import SOURCE, ServerProcess, health, metrics, run_to_end


def flip_a_bit(path, offset):
    data = bytearray(path.read_bytes())
    data[offset] ^= 4
    path.write_bytes(data)


class DamageTest(DurableTest):
    def done_job(self, name):
        job = self.create(name).name
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        return job

    def stopped_with_a_job(self):
        """Its name, on disk, the server gone; and the files of uploads, volumes and results."""
        server = self.start()
        job = self.done_job(durable.send_volume(self.channel, *volume()))
        self.assertEqual(server.stop(), 0)
        return job, {path for path in self.files() if "tenants" in path.parts}

    def test_files_without_their_tables_stay_and_the_server_does_not_start(self):
        job, kept = self.stopped_with_a_job()
        tables = self.data / "jobs.db"
        saved = tables.rename(self.data / "saved")
        ended = run_to_end("--listen", "127.0.0.1:0", "--data-dir", str(self.data))
        self.assertEqual(ended.returncode, 1)
        self.assertIn("--unknown-data adopt", ended.stderr)
        self.assertEqual({path for path in self.files() if "tenants" in path.parts}, kept)
        saved.rename(tables)
        self.start()
        self.assertTrue(durable.read_skeleton(self.channel, job).summary.sha256)

    def test_a_result_that_is_found_damaged_when_it_is_read_is_made_anew(self):
        self.start()
        name = durable.send_volume(self.channel, *volume())
        first = self.done_job(name)
        result, = self.data.rglob("results/*")
        result.unlink()
        self.fails(Code.DATA_LOSS, "STORED_DATA_DAMAGED",
                   lambda: durable.read_skeleton(self.channel, first))
        self.fails(Code.DATA_LOSS, "STORED_DATA_DAMAGED",
                   lambda: durable.read_skeleton(self.channel, first))
        self.done_job(name)
        self.assertTrue(durable.read_skeleton(self.channel, first).summary.sha256)

    def test_flipped_bits_of_the_tables_never_make_a_wrong_answer(self):
        job, _ = self.stopped_with_a_job()
        tables = self.data / "jobs.db"
        good = tables.read_bytes()
        server = self.start()
        expected = self.get(job)
        self.channel.close()
        self.kill(server)
        for at in [at + n for at in find_all(good, job.encode()) for n in range(-40, 120, 40)]:
            for log in self.data.glob("jobs.db-*"):
                log.unlink()
            tables.write_bytes(good)
            flip_a_bit(tables, at)
            self.expect_the_truth(job, expected, at)

    def expect_the_truth(self, job, expected, at):
        with ServerProcess("--data-dir", str(self.data), "--threads", "1") as server:
            if not server.address:
                return  # it does not start: that is no wrong answer
            with grpc.insecure_channel(server.address) as channel:
                try:
                    stub = jobs_grpc.JobServiceStub(channel)
                    self.assertEqual(stub.GetJob(jobs.GetJobRequest(job=job)).job, expected, at)
                except grpc.RpcError as error:
                    self.assertEqual(error.code(), Code.DATA_LOSS, at)

    def test_health_of_durable_calls_follows_the_tables(self):
        server = self.start()
        durable_services = ("bccskel.v1.JobService", "bccskel.v1.VolumeService")
        name = durable.send_volume(self.channel, *volume())
        self.assertEqual([health(self.channel, s) for s in durable_services], [1, 1])
        (self.data / "jobs.db").rename(self.data / "moved")
        for service in durable_services:
            self.wait_for_health(service, 2)
        self.assertEqual(health(self.channel), 1)
        self.assertEqual(health(self.channel, "bccskel.v1.SkeletonizationService"), 1)
        self.fails(Code.DATA_LOSS, "STORED_DATA_DAMAGED", lambda: self.create(name))
        (self.data / "moved").rename(self.data / "jobs.db")
        for service in durable_services:
            self.wait_for_health(service, 1)  # without a call: none may come before
        self.done_job(name)
        server.wait_for_event("data is damaged")
        server.wait_for_event("data is intact again")

    def wait_for_health(self, service, wanted):
        while health(self.channel, service) != wanted:  # the test's time limit ends it
            time.sleep(0.05)


@unittest.skipUnless(shutil.which("promtool"), "no promtool")
class AlertTest(DurableTest):
    """The rules, on what a server really tells."""

    def test_the_first_loss_raises_the_alert(self):
        server = self.start("--metrics-listen", "127.0.0.1:0")
        page = server.line_after("metrics at ")
        name = durable.send_volume(self.channel, *volume())
        done = self.create(name).name
        self.finish(done)
        before = metrics(page)
        next(self.data.rglob("results/*")).unlink()
        self.fails(Code.DATA_LOSS, "STORED_DATA_DAMAGED",
                   lambda: durable.read_skeleton(self.channel, done))
        blob, = self.data.rglob("blobs/*")
        flip_a_bit(blob, 20)
        lost = self.create(name, options=shell_width(2)).name
        self.assertEqual(self.finish(lost)[-1], jobs.JOB_STATE_FAILED)
        after = metrics(page)
        rose = {series for series in after if float(after[series]) > float(before.get(series, 0))}
        for counter in ("bccskel_calls_total", "bccskel_durable_jobs_ended_total"):
            with self.subTest(counter):
                self.expect_alert(before, after, [series for series in rose if counter in series
                                                  and "DATA_LOSS" in series])

    def expect_alert(self, before, after, series):
        self.assertTrue(series)
        labels = yaml.safe_load(re.sub(r"(\w+)=", r"\1: ", series[0][series[0].index("{"):]))
        alert = {"exp_labels": {"severity": "critical", **labels}, "exp_annotations": {
            "summary": ": a stored file does not match its checksum", "description":
            "Look at the disk below --data-dir. Submit the affected jobs again."}}
        test = {"rule_files": [str(SOURCE / "docker/prometheus/alerts.yml")], "tests": [{
            "interval": "10s",
            "input_series": [{"series": name, "values":
                              " ".join([before[name] if name in before else "_"] * 6
                                       + [after[name]] * 12)} for name in series],
            "alert_rule_test": [{"eval_time": "2m", "alertname": "BccskelDataLoss",
                                 "exp_alerts": [alert]}]}]}
        with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
            yaml.safe_dump(test, file)
            file.flush()
            ended = subprocess.run(["promtool", "test", "rules", file.name], capture_output=True,
                                   text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)


def find_all(data, text):
    at = data.find(text)
    while at >= 0:
        yield at
        at = data.find(text, at + 1)


if __name__ == "__main__":
    unittest.main()
