"""Uploads, jobs and results that outlive connections, callers and the server's process."""

import hashlib
import json
import signal
import time
import unittest

import grpc
import numpy as np

import server_process
from durable_case import DurableTest, large_requests, large_volume, upload_requests, volume
from interface import (EXAMPLES, Code, HeldBack, details, durable, example, jobs, jobs_grpc,
                       options_pb2, run_python, service, service_grpc, shell_width, volume_pb2,
                       volumes)
from server_process import ServerProcess


def fault_of(status):
    """The ErrorInfo of a stored error."""
    for detail in status.details:
        if detail.type_url.endswith("ErrorInfo"):
            return details.ErrorInfo.FromString(detail.value)
    return None


class JobTest(DurableTest):
    def test_a_job_gives_the_skeleton_of_one_call(self):
        self.start()
        name = durable.send_volume(self.channel, *volume())
        job = durable.create_job(self.channel, name)
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
        skeleton = durable.read_skeleton(self.channel, job)
        expected = example.skeletonize(self.channel, example.torus())
        self.assertEqual(skeleton.summary.sha256, expected.summary.sha256)
        found = self.get(job)
        self.assertEqual(found.state, jobs.JOB_STATE_SUCCEEDED)
        self.assertEqual(found.summary.sha256, expected.summary.sha256)
        self.assertEqual(found.volume, name)
        self.assertGreater(found.result_pieces, 1)
        last = list(self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(
            job=job, piece_index=found.result_pieces - 1)))
        self.assertEqual([piece.piece_index for piece in last], [found.result_pieces - 1])
        self.assertTrue(last[0].HasField("summary"))

    def test_what_the_server_has_is_not_sent_again(self):
        self.start()
        declaration, data = volume()
        name = durable.send_volume(self.channel, declaration, data)
        key = volumes.VolumeKey(declaration=declaration, blob_sha256=hashlib.sha256(data).digest())
        moved = volumes.VolumeKey()
        moved.CopyFrom(key)
        moved.declaration.placement.origin[0] = 5
        found = self.volumes.FindMissingVolumes(volumes.FindMissingVolumesRequest(
            volumes=[moved, key]))
        self.assertEqual(list(found.volumes), ["", name])

    def test_pages_hold_every_job_once(self):
        self.start()
        name = durable.send_volume(self.channel, *volume())
        made = [self.create(name).name for _ in range(7)]
        found, token = [], ""
        while True:
            page = self.jobs.ListJobs(jobs.ListJobsRequest(page_size=3, page_token=token))
            self.assertLessEqual(len(page.jobs), 3)
            found += [job.name for job in page.jobs]
            token = page.next_page_token
            if not token:
                break
        self.assertEqual(found, made[::-1])

    def test_lists_omit_the_points_to_keep(self):
        self.start()
        options = shell_width(1)
        options.keep.MergeFrom(options_pb2.LatticePoints(x=[1], y=[1], z=[3]))
        job = self.create(durable.send_volume(self.channel, *volume()), options=options).name
        [listed] = self.jobs.ListJobs(jobs.ListJobsRequest()).jobs
        self.assertEqual(listed.name, job)
        self.assertFalse(listed.options.HasField("keep"))
        self.assertEqual(self.get(job).options.keep, options.keep)

    def test_unknown_fields_of_a_declaration_are_not_stored(self):
        self.start()
        declaration, data = volume()
        padded = type(declaration)()
        unknown = b"\xa2\x06\x05" + 5 * b"x"  # field 100
        padded.ParseFromString(declaration.SerializeToString() + unknown)
        self.volumes.UploadVolume(upload_requests("uploads/padded", padded, data, len(data)))
        upload = self.volumes.UploadVolume(upload_requests(
            "uploads/padded", declaration, data, finish=True)).upload
        self.assertEqual(upload.committed_size, len(data))

    def test_errors_say_what_is_wrong(self):
        self.start()
        none = "jobs/none"
        self.fails(Code.FAILED_PRECONDITION, "VOLUME_MISSING", lambda: self.create("volumes/none"))
        self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID", lambda: self.create(""))
        self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID", lambda: self.create("volumes/x", "\n"))
        self.fails(Code.NOT_FOUND, "NOT_FOUND", lambda: self.get(none))
        self.fails(Code.NOT_FOUND, "NOT_FOUND",
                   lambda: self.jobs.CancelJob(jobs.CancelJobRequest(job=none)))
        self.fails(Code.NOT_FOUND, "NOT_FOUND",
                   lambda: list(self.jobs.WatchJob(jobs.WatchJobRequest(job=none))))
        self.fails(Code.NOT_FOUND, "NOT_FOUND",
                   lambda: list(self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=none))))
        self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                   lambda: self.jobs.ListJobs(jobs.ListJobsRequest(page_size=1001)))
        validated = self.create(durable.send_volume(self.channel, *volume()), validate_only=True)
        self.assertEqual(validated.name, "")
        self.assertEqual(len(self.jobs.ListJobs(jobs.ListJobsRequest()).jobs), 0)

    def test_a_job_that_has_not_succeeded_has_nothing_to_read(self):
        self.start()
        name = durable.send_volume(self.channel, *large_volume())
        for shell in range(1, 20):  # one thread computes them all before the last one
            job = self.create(name, options=shell_width(1 + shell / 10)).name
        self.fails(Code.FAILED_PRECONDITION, "JOB_NOT_SUCCEEDED",
                   lambda: list(self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=job))))
        ended = self.jobs.CancelJob(jobs.CancelJobRequest(job=job)).job
        self.assertEqual(ended.state, jobs.JOB_STATE_CANCELLED)
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_CANCELLED)

    def test_a_malformed_volume_fails_its_job(self):
        self.start()
        declaration, data = volume()
        declaration.encoding = volume_pb2.VOLUME_ENCODING_OPENEXR
        declaration.size_bytes = len(data)
        job = self.create(durable.send_volume(self.channel, declaration, data)).name
        self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_FAILED)
        self.assertEqual(self.get(job).error.code, Code.INVALID_ARGUMENT.value[0])

    def test_the_metrics_say_what_is_kept(self):
        server = self.start("--metrics-listen", "127.0.0.1:0")
        page = server.line_after("metrics at ")
        declaration, data = volume()
        name = durable.send_volume(self.channel, declaration, data)
        for _ in range(2):
            self.finish(self.create(name).name)
        self.volumes.UploadVolume(iter([volumes.UploadVolumeRequest(
            config=volumes.UploadVolumeConfig(upload="uploads/begun", volume=declaration))]))
        kept = server_process.metrics(page)
        result_bytes = self.jobs.ListJobs(jobs.ListJobsRequest()).jobs[0].result_bytes
        for figure, value in {"bccskel_uploads_unfinished": 1, "bccskel_durable_jobs_queued": 0,
                              "bccskel_durable_jobs_running": 0, "bccskel_results_reused_total": 1,
                              "bccskel_disk_used_bytes": 2 * len(data) + result_bytes}.items():
            self.assertEqual(float(kept[figure]), value, figure)
        self.assertGreater(float(kept["bccskel_disk_available_bytes"]), 0)
        failed = [name for name in kept if name.startswith("bccskel_calls_total")
                  and 'code="OK"' not in name and float(kept[name]) > 0]
        self.assertEqual(failed, [], "an ordinary upload asks for nothing that cannot be there")

    def test_without_a_data_directory_the_calls_name_the_flag(self):
        with ServerProcess() as server, grpc.insecure_channel(server.address) as channel:
            stub = jobs_grpc.JobServiceStub(channel)
            error = self.fails(Code.FAILED_PRECONDITION, "NOT_DURABLE",
                               lambda: stub.GetJob(jobs.GetJobRequest(job="jobs/1")))
            self.assertIn("--data-dir", error.details())


class EraseTest(DurableTest):
    def found(self, traces):
        """Which of them are anywhere in the files."""
        files = [path.read_bytes() for path in self.files()]
        return {name for name, trace in traces.items() if any(trace in file for file in files)}

    def test_deleting_erases_bytes_names_and_digests(self):
        self.start()
        before = self.files()
        declaration, data = volume()
        name = durable.send_volume(self.channel, declaration, data, "uploads/of-patient-4711")
        job = self.create(name, "request-of-patient-4711").name
        self.finish(job)
        occupied = next(at for at in range(len(data)) if data[at])
        digest = hashlib.sha256(data).digest()
        traces = {"volume": data[occupied:occupied + 64], "request": b"request-of-patient-4711",
                  "upload": b"of-patient-4711", "job": job.removeprefix("jobs/").encode(),
                  "volume's name": name.removeprefix("volumes/").encode(),
                  "skeleton's digest": self.get(job).summary.sha256}
        self.assertEqual(self.found(traces), set(traces))
        traces |= {"digest": digest, "digest, written": digest.hex().encode()}
        self.assertTrue(self.found(traces) & {"digest", "digest, written"})
        self.jobs.DeleteJob(jobs.DeleteJobRequest(job=job))
        self.volumes.DeleteVolume(volumes.DeleteVolumeRequest(volume=name))
        self.assertEqual(self.found(traces), set())
        left = self.files() - before
        self.assertFalse([path for path in left if path.suffix not in (".db", ".db-wal", ".db-shm")
                          and path.stat().st_size > 0], left)
        self.fails(Code.NOT_FOUND, "NOT_FOUND", lambda: self.get(job))


class UploadTest(DurableTest):
    def chunk(self, data, offset, size=None):
        return volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(
            offset=offset, data=data[offset:offset + (size or durable.CHUNK_BYTES)]))

    def config(self, declaration, name="uploads/a"):
        return volumes.UploadVolumeRequest(config=volumes.UploadVolumeConfig(
            upload=name, volume=declaration))

    def status(self, name="uploads/a"):
        return self.volumes.GetUploadStatus(volumes.GetUploadStatusRequest(upload=name)).upload

    def test_a_half_closed_upload_stays_and_is_gone_on_with(self):
        self.start()
        declaration, data = volume(60.0, 20.0)
        answer = self.volumes.UploadVolume(iter([self.config(declaration),
                                                 self.chunk(data, 0, 1000)]))
        self.assertEqual((answer.upload.committed_size, answer.upload.volume), (1000, ""))
        self.fails(Code.OUT_OF_RANGE, "CHUNK_OFFSET", lambda: self.volumes.UploadVolume(
            iter([self.config(declaration), self.chunk(data, 0, 1000)])))
        self.assertTrue(durable.send_volume(self.channel, declaration, data, "uploads/a"))
        self.assertEqual(self.status().committed_size, len(data))

    def test_wrong_uploads_are_told_apart(self):
        self.start()
        declaration, data = volume()
        other, _ = volume(30.0, 8.0)
        self.volumes.UploadVolume(iter([self.config(declaration), self.chunk(data, 0, 1000)]))
        self.fails(Code.ALREADY_EXISTS, "UPLOAD_EXISTS",
                   lambda: self.volumes.UploadVolume(iter([self.config(other)])))
        self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                   lambda: self.volumes.UploadVolume(iter([self.config(declaration, "me")])))
        self.fails(Code.INVALID_ARGUMENT, "REQUEST_ORDER",
                   lambda: self.volumes.UploadVolume(iter([self.chunk(data, 0)])))
        wrong = self.chunk(data, 1000, 1000)
        wrong.chunk.crc32c = 1
        error = self.fails(Code.INVALID_ARGUMENT, "CHUNK_CHECKSUM", lambda:
                           self.volumes.UploadVolume(iter([self.config(declaration), wrong])))
        self.assertIn("1000", str(self.status().committed_size), error.details())

    def test_a_newer_stream_takes_an_upload_over(self):
        self.start()
        declaration, data = volume(60.0, 20.0)
        requests = HeldBack([self.config(declaration), self.chunk(data, 0, 1000)], first=2)
        first = self.volumes.UploadVolume.future(iter(requests))
        while True:  # the test's time limit ends it
            try:
                if self.status().committed_size == 1000:
                    break
            except grpc.RpcError:
                pass
        name = durable.send_volume(self.channel, declaration, data, "uploads/a")
        self.assertTrue(name)
        self.assertEqual(first.exception().code(), Code.ABORTED)
        requests.let_go()

    def test_a_message_of_5_mib_is_refused(self):
        self.start()
        declaration, _ = large_volume()
        too_long = volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(data=bytes(5 << 20)))
        with self.assertRaises(grpc.RpcError) as raised:
            self.volumes.UploadVolume(iter([self.config(declaration), too_long]))
        self.assertEqual(raised.exception.code(), Code.RESOURCE_EXHAUSTED)

    def test_after_a_kill_of_the_sender_at_most_one_chunk_is_sent_again(self):
        server = self.start()
        declaration, data = large_volume()
        sender = run_python("-c", KILLED_SENDER, server.address)
        self.assertEqual(sender.returncode, -signal.SIGKILL)
        # What it had handed over arrives although it is gone.
        sent, committed = 3 * durable.CHUNK_BYTES, -1
        while committed < sent - durable.CHUNK_BYTES:  # the test's time limit ends it
            committed = durable.committed_size(self.volumes, "uploads/killed")
        rest = list(durable.upload_requests("uploads/killed", declaration, data, committed))
        self.assertTrue(self.volumes.UploadVolume(iter(rest)).upload.volume)
        resent = sent + sum(len(request.chunk.data) for request in rest) - len(data)
        print(f"resent {resent} of {sent} bytes, a chunk has {durable.CHUNK_BYTES}")
        self.assertLessEqual(resent, durable.CHUNK_BYTES)


KILLED_SENDER = """
import os, signal, sys, time
import grpc
import durable, numpy
from skeletonize import declare, torus
channel = grpc.insecure_channel(sys.argv[1])
stub = durable.volumes_grpc.VolumeServiceStub(channel)
declaration, data = declare(torus(200.0, 60.0), 1.0, (0, 0, 0), numpy.eye(3))
durable.CHUNK_BYTES = 1 << 17
def some():
    for number, request in enumerate(durable.upload_requests("uploads/killed", declaration, data, 0)):
        if number == 4:
            while durable.committed_size(stub, "uploads/killed") < 2 * durable.CHUNK_BYTES:
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGKILL)
        yield request
stub.UploadVolume(some())
"""


class CrashTest(DurableTest):
    def test_uploads_go_on_after_a_kill_of_the_server(self):
        server = self.start()
        declaration, data = large_volume()
        half = len(data) // 2
        self.volumes.UploadVolume(upload_requests("uploads/a", declaration, data[:half]))
        self.kill(server)
        self.start()
        self.assertEqual(durable.committed_size(self.volumes, "uploads/a"), half)
        self.assertTrue(durable.send_volume(self.channel, declaration, data, "uploads/a"))

    def test_jobs_are_neither_lost_nor_doubled_by_kills_of_the_server(self):
        server = self.start()
        name = durable.send_volume(self.channel, *volume(60.0, 20.0))
        made = {}
        for round_number in range(3):
            for n in range(5):
                request = f"{round_number}-{n}"
                made[request] = self.create(name, request, options=options_pb2.SkeletonizeOptions(
                    last_shell=1 + len(made))).name
            self.kill(server)
            server = self.start()
        for request, job in made.items():
            self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)
            self.assertEqual(self.create(name, request, options=self.get(job).options).name, job)
        listed = self.jobs.ListJobs(jobs.ListJobsRequest(page_size=1000)).jobs
        self.assertEqual(sorted(job.name for job in listed), sorted(made.values()))

    def test_a_job_that_is_at_work_at_three_kills_is_given_up_and_others_go_on(self):
        server = self.start()
        noise = np.random.default_rng(1).random((2, 100, 100, 100)) < 0.45  # seconds of work
        poison = self.create(durable.send_volume(
            self.channel, *example.declare(noise, 1.0, (0, 0, 0), np.eye(3)))).name
        others = [self.create(durable.send_volume(self.channel, *volume(24.0 + n))).name
                  for n in range(3)]
        for _ in range(3):
            while self.get(poison).state != jobs.JOB_STATE_RUNNING:  # the test's time limit ends it
                time.sleep(0.01)
            self.kill(server)
            server = self.start()
        self.assertEqual(self.finish(poison)[-1], jobs.JOB_STATE_FAILED)
        error = self.get(poison).error
        self.assertEqual((error.code, fault_of(error).reason),
                         (Code.INTERNAL.value[0], "POISONED"), error)
        self.assertEqual(self.get(poison).attempts, 3)
        for job in (*others, self.create(durable.send_volume(self.channel, *volume(40.0))).name):
            self.assertEqual(self.finish(job)[-1], jobs.JOB_STATE_SUCCEEDED)

    def test_a_watch_goes_on_where_it_was(self):
        server = self.start()
        job = self.create(durable.send_volume(self.channel, *large_volume())).name
        first = next(iter(self.jobs.WatchJob(jobs.WatchJobRequest(job=job))))
        self.kill(server)
        self.start()
        events = list(durable.watch(self.channel, job, first.sequence))
        sequences = [event.sequence for event in events]
        self.assertEqual(sequences, sorted(set(sequences)))
        self.assertGreater(sequences[0], first.sequence)
        self.assertEqual(events[-1].state_change.state, jobs.JOB_STATE_SUCCEEDED)

    def test_one_call_that_breaks_is_gone_on_with(self):
        server = self.start()
        declaration, data = large_volume()
        half = HeldBack([
            service.SkeletonizeRequest(config=service.SkeletonizeConfig(volume=declaration)),
            service.SkeletonizeRequest(chunk=volume_pb2.VolumeChunk(data=data[:100_000]))], first=2)
        replies = service_grpc.SkeletonizationServiceStub(self.channel).Skeletonize(iter(half))
        accepted = next(replies).accepted
        self.assertTrue(accepted.durable)
        self.kill(server)
        half.let_go()
        self.start()
        self.assertEqual(self.get(accepted.job).state, jobs.JOB_STATE_RECEIVING)
        durable.send_volume(self.channel, declaration, data, accepted.upload)
        self.assertEqual(self.finish(accepted.job)[-1], jobs.JOB_STATE_SUCCEEDED)
        skeleton = durable.read_skeleton(self.channel, accepted.job)
        self.assertEqual(skeleton.summary.certificate.skeleton.loops, 1)


class OneCallTest(DurableTest):
    def test_large_volumes_are_durable_and_small_ones_are_not(self):
        self.start()
        stub = service_grpc.SkeletonizationServiceStub(self.channel)
        small = list(stub.Skeletonize(example.requests(example.torus())))
        large = list(stub.Skeletonize(large_requests()))
        self.assertFalse(small[0].accepted.durable)
        self.assertTrue(large[0].accepted.durable)
        self.assertTrue(large[-1].HasField("summary"))
        self.assertEqual(self.get(large[0].accepted.job).summary.sha256, large[-1].summary.sha256)

    def test_a_call_that_asks_for_the_points_of_shells_is_not_durable_whatever_its_policy(self):
        self.start()
        stub = service_grpc.SkeletonizationServiceStub(self.channel)
        requests = list(large_requests())
        requests[0].config.shell_points_return = service.SHELL_POINTS_RETURN_ALL
        requests[0].config.on_disconnect = service.DISCONNECT_POLICY_CONTINUE
        replies = list(stub.Skeletonize(iter(requests)))
        self.assertFalse(replies[0].accepted.durable)
        self.assertEqual(replies[0].accepted.upload, "")
        self.assertTrue(any(reply.HasField("shell_points") for reply in replies))
        self.assertTrue(replies[-1].HasField("summary"))
        self.fails(Code.NOT_FOUND, "NOT_FOUND", lambda: self.get(replies[0].accepted.job))

    def test_an_unknown_policy_is_refused(self):
        self.start()
        requests = list(large_requests())
        requests[0].config.on_disconnect = 9
        stub = service_grpc.SkeletonizationServiceStub(self.channel)
        error = self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                           lambda: list(stub.Skeletonize(iter(requests))))
        self.assertIn("on_disconnect", error.details())

    def test_a_cancelled_call_ends_its_job_only_where_asked(self):
        self.start()
        declaration, data = large_volume()
        for policy, state in ((service.DISCONNECT_POLICY_CANCEL, jobs.JOB_STATE_CANCELLED),
                              (service.DISCONNECT_POLICY_CONTINUE, jobs.JOB_STATE_SUCCEEDED)):
            config_only = HeldBack([service.SkeletonizeRequest(config=service.SkeletonizeConfig(
                volume=declaration, on_disconnect=policy))])
            replies = service_grpc.SkeletonizationServiceStub(self.channel).Skeletonize(
                iter(config_only))
            accepted = next(replies).accepted
            replies.cancel()
            config_only.let_go()
            if policy == service.DISCONNECT_POLICY_CONTINUE:
                durable.send_volume(self.channel, declaration, data, accepted.upload)
            self.assertEqual(self.finish(accepted.job)[-1], state)

    def test_a_call_whose_job_is_ended_while_it_sends_is_cancelled(self):
        self.start()
        ends = (lambda it: self.jobs.CancelJob(jobs.CancelJobRequest(job=it.job)),
                lambda it: self.jobs.DeleteJob(jobs.DeleteJobRequest(job=it.job)),
                lambda it: self.volumes.DeleteUpload(
                    volumes.DeleteUploadRequest(upload=it.upload)))
        for end in ends:
            requests = HeldBack(large_requests())
            replies = service_grpc.SkeletonizationServiceStub(self.channel).Skeletonize(
                iter(requests))
            end(next(replies).accepted)
            requests.let_go()
            self.fails(Code.CANCELLED, "CANCELLED", lambda: list(replies))

    def test_a_cancelled_job_says_so(self):
        server = self.start()
        job = self.create(durable.send_volume(self.channel, *large_volume())).name
        self.jobs.CancelJob(jobs.CancelJobRequest(job=job))
        self.assertEqual(self.get(job).error.code, Code.CANCELLED.value[0])
        *_, last = durable.watch(self.channel, job)
        self.assertEqual(last.state_change.error.code, Code.CANCELLED.value[0])
        lines = [json.loads(line) for line in server.log_text().splitlines()]
        states = {line["state"]: line for line in lines if line["event"] == "job state"}
        self.assertEqual((states["CANCELLED"]["code"], states["CANCELLED"]["reason"]),
                         ("CANCELLED", "CANCELLED"))


class ExampleTest(DurableTest):
    def test_it_tries_again_what_a_stopping_server_cancels_and_not_what_a_caller_cancels(self):
        class Cancelled(grpc.RpcError):
            def __init__(self, reason=None):
                super().__init__()
                info = details.ErrorInfo(reason=reason)
                detail = {"type_url": "type.googleapis.com/google.rpc.ErrorInfo",
                          "value": info.SerializeToString()}
                status = details.Status(details=[detail] if reason else [])
                self.trailing_metadata = lambda: (("grpc-status-details-bin",
                                                   status.SerializeToString()),)
                self.code = lambda: Code.CANCELLED

        def calls(*errors):
            left = list(errors)

            def call():
                if left:
                    raise left.pop(0)
                return "done"

            return call

        self.assertEqual(durable.patiently(calls(Cancelled())), "done")
        with self.assertRaises(Cancelled):
            durable.patiently(calls(Cancelled("CANCELLED")))

    def test_the_example_runs_as_its_text_says(self):
        server = self.start()
        done = run_python(EXAMPLES / "durable.py", "--server", server.address)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("JOB_STATE_SUCCEEDED", done.stdout)
        self.assertTrue(done.stdout.endswith(" 1 loops\n"), done.stdout)


if __name__ == "__main__":
    unittest.main()
