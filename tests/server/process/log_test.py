"""What the log says of calls and of jobs that outlive them."""

import contextlib
import json
import subprocess
import time
import unittest

import grpc

import server_process
from durable_case import DurableTest, large_requests, large_volume, volume
from interface import Code, durable, jobs, service_grpc, torus_loops, volume_pb2, volumes

TRACE = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"
TRACED = (("traceparent", TRACE),)


def lines_of(server, event):
    return [line for line in map(json.loads, server.log_text().splitlines())
            if line["event"] == event]


class JobLogTest(DurableTest):
    def start(self, *flags):
        return super().start("--log-level", "debug", *flags)

    def create_traced(self, name, **more):
        return self.jobs.CreateJob(jobs.CreateJobRequest(volume=name, **more), metadata=TRACED).job

    def states(self, server, job):
        return [(line["state"], line["attempt"], line["reason"])
                for line in lines_of(server, "job state") if line["job"] == job]

    def test_every_state_of_a_job_is_told_with_tenant_and_trace(self):
        server = self.start()
        job = self.create_traced(durable.send_volume(self.channel, *volume())).name
        self.finish(job)
        self.assertEqual(server.stop(), 0)
        self.assertEqual(self.states(server, job), [("QUEUED", 0, ""), ("RUNNING", 1, ""),
                                                    ("SUCCEEDED", 1, "")])
        for line in lines_of(server, "job state"):
            self.assertEqual((line["tenant"], line["traceparent"]), ("default", TRACE))

    def test_a_failed_job_says_why(self):
        server = self.start()
        declaration, data = volume()
        declaration.encoding = volume_pb2.VOLUME_ENCODING_OPENEXR
        job = self.create_traced(durable.send_volume(self.channel, declaration, data)).name
        self.finish(job)
        self.assertEqual(server.stop(), 0)
        self.assertEqual(self.states(server, job)[-1], ("FAILED", 1, "VOLUME_INVALID"))
        self.assertEqual(lines_of(server, "job state")[-1]["level"], "warning")

    def test_a_job_that_crashes_servers_is_told_as_poisoned_with_its_trace(self):
        server = self.start()
        name = durable.send_volume(self.channel, *large_volume())
        job = self.create_traced(name).name
        for _ in range(3):
            while self.get(job).state != jobs.JOB_STATE_RUNNING:
                time.sleep(0.01)
            self.kill(server)
            server = self.start()
        self.assertEqual(self.get(job).state, jobs.JOB_STATE_FAILED)
        self.assertEqual(server.stop(), 0)
        self.assertEqual(self.states(server, job), [("FAILED", 3, "POISONED")])
        line = lines_of(server, "job state")[0]
        self.assertEqual((line["level"], line["traceparent"]), ("error", TRACE))

    def test_every_call_is_told_with_its_method(self):
        server = self.start()
        name = durable.send_volume(self.channel, *volume())
        job = self.create_traced(name).name
        self.finish(job)
        durable.read_skeleton(self.channel, job)
        self.jobs.CancelJob(jobs.CancelJobRequest(job=job))
        self.get(job)
        self.jobs.DeleteJob(jobs.DeleteJobRequest(job=job))
        self.fails(Code.NOT_FOUND, "NOT_FOUND", lambda: self.get(job))
        self.volumes.DeleteVolume(volumes.DeleteVolumeRequest(volume=name))
        self.assertEqual(server.stop(), 0)
        ended = {line["method"].removeprefix("/bccskel.v1."): line
                 for line in lines_of(server, "call ended")}
        for method in ("CreateJob", "WatchJob", "ReadSkeleton", "CancelJob", "DeleteJob"):
            line = ended["JobService/" + method]
            self.assertEqual((line["job"], line["code"], line["level"]), (job, "OK", "info"), method)
        self.assertEqual(ended["JobService/CreateJob"]["traceparent"], TRACE)
        self.assertTrue(ended["VolumeService/UploadVolume"]["upload"].startswith("uploads/"))
        self.assertEqual(ended["VolumeService/DeleteVolume"]["volume"], name)
        self.assertEqual(ended["VolumeService/FindMissingVolumes"]["level"], "debug")
        asked = [line for line in lines_of(server, "call ended")
                 if line["method"].endswith("/GetJob")]
        self.assertEqual([(line["level"], line["reason"]) for line in asked],
                         [("debug", ""), ("warning", "NOT_FOUND")])

    def test_a_name_of_no_known_form_is_told_as_a_name(self):
        server = self.start()
        with self.assertRaises(grpc.RpcError):
            self.create("nope")
        self.assertEqual(server.stop(), 0)
        line = lines_of(server, "call ended")[-1]
        self.assertEqual((line["name"], line.get("job")), ("nope", None))

    def test_a_call_that_the_stop_cuts_off_is_told_as_draining(self):
        for data in ((), ("--data-dir", str(self.data))):
            with server_process.ServerProcess("--drain-ms", "0", *data) as server:
                with grpc.insecure_channel(server.address) as channel:
                    self.cut_off(server, channel)
                line = lines_of(server, "call ended")[-1]
                self.assertEqual((line["code"], line["reason"]), ("UNAVAILABLE", "DRAINING"), line)

    def begin(self, server, channel):
        """A call that is accepted and says nothing more."""
        stub = service_grpc.SkeletonizationServiceStub(channel)
        call = stub.Skeletonize(first_request(server))
        self.assertTrue(next(call).HasField("accepted"))
        return call

    def cut_off(self, server, channel):
        call = self.begin(server, channel)
        self.assertEqual(server.stop(), 0)
        with contextlib.suppress(grpc.RpcError):
            list(call)

    def test_a_caller_who_vanishes_is_told_as_cancelled(self):
        server = self.start()
        self.begin(server, self.channel).cancel()
        while not lines_of(server, "call ended"):
            time.sleep(0.02)
        self.assertEqual(lines_of(server, "call ended")[-1]["code"], "CANCELLED")
        server.stop()


class UnreadLogTest(unittest.TestCase):
    def test_a_server_whose_log_nobody_reads_serves_and_ends(self):
        process = subprocess.Popen(
            [server_process.BINARY, "--listen", "127.0.0.1:0", "--log-level", "debug",
             "--metrics-listen", "127.0.0.1:0"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        address = process.stdout.readline().removeprefix("listening on ").strip()
        page = process.stdout.readline().removeprefix("metrics at ").strip()
        with grpc.insecure_channel(address) as channel:
            get = channel.unary_unary("/bccskel.v1.JobService/GetJob")
            for _ in range(10_000):  # more lines than the queue and the pipe hold
                with self.assertRaises(grpc.RpcError) as raised:
                    get(b"\x0a\x01\xff", timeout=server_process.TIMEOUT_S)  # a name that is not UTF-8
                self.assertNotEqual(raised.exception.code(), Code.DEADLINE_EXCEEDED)
            self.assertEqual(torus_loops(channel), 1)
        self.assertGreater(float(server_process.metrics(page)["bccskel_log_lines_dropped_total"]), 0)
        process.terminate()
        self.assertEqual(process.wait(server_process.TIMEOUT_S), 0)


def first_request(server):
    yield next(large_requests())
    server.process.wait(server_process.TIMEOUT_S)


if __name__ == "__main__":
    unittest.main()
