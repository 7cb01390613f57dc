"""What tenants of a server with a data directory see of each other: nothing."""

import hashlib
import tempfile
import unittest

import grpc

from durable_case import DurableTest, volume
from interface import (bearer, durable, example, jobs, jobs_grpc, service_grpc, volume_pb2, volumes,
                       volumes_grpc)
from server_process import new_token


class WithToken(grpc.UnaryUnaryClientInterceptor, grpc.UnaryStreamClientInterceptor,
                grpc.StreamUnaryClientInterceptor, grpc.StreamStreamClientInterceptor):
    def __init__(self, token):
        self.metadata = bearer(token)

    def with_token(self, continuation, details, request):
        return continuation(details._replace(metadata=self.metadata), request)

    intercept_unary_unary = intercept_unary_stream = with_token
    intercept_stream_unary = intercept_stream_stream = with_token


class Tenant:
    def __init__(self, server, token):
        self.channel = grpc.intercept_channel(grpc.insecure_channel(server.address), WithToken(token))
        self.volumes = volumes_grpc.VolumeServiceStub(self.channel)
        self.jobs = jobs_grpc.JobServiceStub(self.channel)

    def make_job(self, volume, request_id=""):
        """Its name, once it has ended."""
        job = self.jobs.CreateJob(jobs.CreateJobRequest(volume=volume, request_id=request_id)).job
        for _ in durable.watch(self.channel, job.name):
            pass
        return job.name

    def attempts(self, job):
        return self.jobs.GetJob(jobs.GetJobRequest(job=job)).job.attempts


class IsolationTest(DurableTest):
    def setUp(self):
        super().setUp()
        tokens = [new_token(tenant) for tenant in ("acme", "lab")]
        file = tempfile.NamedTemporaryFile("w")
        self.addCleanup(file.close)
        file.write("".join(line + "\n" for _, line in tokens))
        file.flush()
        server = self.start("--tokens", file.name)
        self.acme, self.lab = (Tenant(server, token) for token, _ in tokens)
        self.declaration, self.data = volume()
        self.volume = durable.send_volume(self.acme.channel, self.declaration, self.data)
        self.acme.volumes.UploadVolume(iter([self.config("uploads/begun"), self.chunk(1000)]))
        self.job = self.acme.make_job(self.volume, "acme-1")

    def config(self, upload):
        return volumes.UploadVolumeRequest(config=volumes.UploadVolumeConfig(
            upload=upload, volume=self.declaration))

    def chunk(self, size):
        return volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(
            data=self.data[:size]))

    def missing(self, data):
        return volumes.FindMissingVolumesRequest(volumes=[volumes.VolumeKey(
            declaration=self.declaration, blob_sha256=hashlib.sha256(data).digest())])

    def calls(self, upload, volume, job, data):
        """The lab's call of each method on these names."""
        at_volumes, at_jobs = self.lab.volumes, self.lab.jobs
        return {
            "GetUploadStatus": lambda: at_volumes.GetUploadStatus(
                volumes.GetUploadStatusRequest(upload=upload)),
            "DeleteUpload": lambda: at_volumes.DeleteUpload(
                volumes.DeleteUploadRequest(upload=upload)),
            "FindMissingVolumes": lambda: at_volumes.FindMissingVolumes(self.missing(data)),
            "DeleteVolume": lambda: at_volumes.DeleteVolume(
                volumes.DeleteVolumeRequest(volume=volume)),
            "UploadVolume": lambda: at_volumes.UploadVolume(iter([self.config(upload)])),
            "CreateJob": lambda: at_jobs.CreateJob(jobs.CreateJobRequest(
                volume=volume, request_id="acme-1")),
            "GetJob": lambda: at_jobs.GetJob(jobs.GetJobRequest(job=job)),
            "ListJobs": lambda: at_jobs.ListJobs(jobs.ListJobsRequest()),
            "CancelJob": lambda: at_jobs.CancelJob(jobs.CancelJobRequest(job=job)),
            "DeleteJob": lambda: at_jobs.DeleteJob(jobs.DeleteJobRequest(job=job)),
            "WatchJob": lambda: list(at_jobs.WatchJob(jobs.WatchJobRequest(job=job))),
            "ReadSkeleton": lambda: list(at_jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=job))),
        }

    def seen(self, method, names):
        """What the lab learns, without the names that it gave itself and the time of the call."""
        try:
            answer = self.calls(*names)[method]()
            if hasattr(answer, "upload"):
                answer.upload.ClearField("expire_time")
            text = f"OK {answer}"
        except grpc.RpcError as error:
            text = f"{error.code().name} {example.error_reason(error)} {error.details()}"
        for name in names[:3]:
            text = text.replace(name, "NAME")
        return text

    def test_what_another_tenant_has_is_like_what_nobody_has(self):
        theirs = ("uploads/begun", self.volume, self.job, self.data)
        nobodys = ("uploads/nobodys", "volumes/" + "0" * 32, "jobs/" + "0" * 32, b"nobody's")
        methods = {method.name for file in (volumes, jobs)
                   for service in file.DESCRIPTOR.services_by_name.values()
                   for method in service.methods}
        self.assertEqual(set(self.calls(*theirs)), methods)
        for method in self.calls(*theirs):
            with self.subTest(method):
                seen = self.seen(method, theirs)
                self.assertEqual(seen, self.seen(method, nobodys))
                wanted = {"FindMissingVolumes": "OK volumes: \"\"", "ListJobs": "OK",
                          "UploadVolume": "OK",
                          "CreateJob": "FAILED_PRECONDITION VOLUME_MISSING"}
                self.assertTrue(seen.startswith(wanted.get(method, "NOT_FOUND NOT_FOUND")), seen)
        self.assert_acme_has_everything()

    def assert_acme_has_everything(self):
        self.assertEqual(durable.committed_size(self.acme.volumes, "uploads/begun"), 1000)
        self.assertEqual(list(self.acme.volumes.FindMissingVolumes(
            self.missing(self.data)).volumes), [self.volume])
        listed = self.acme.jobs.ListJobs(jobs.ListJobsRequest()).jobs
        self.assertEqual([job.name for job in listed], [self.job])
        self.assertEqual(durable.read_skeleton(self.acme.channel, self.job)
                         .summary.certificate.skeleton.loops, 1)

    def test_equal_work_of_another_tenant_is_sent_and_computed_anew(self):
        self.assertEqual(self.acme.attempts(self.acme.make_job(self.volume)), 0)  # given the result
        sent = durable.send_volume(self.lab.channel, self.declaration, self.data)
        own = self.lab.make_job(sent, "acme-1")
        self.assertNotEqual(own, self.job)
        self.assertEqual(self.lab.attempts(own), 1)
        self.lab.jobs.DeleteJob(jobs.DeleteJobRequest(job=own))
        self.lab.volumes.DeleteVolume(volumes.DeleteVolumeRequest(volume=sent))
        self.assertTrue(durable.read_skeleton(self.acme.channel, self.job).summary.sha256)
        self.assertTrue(self.acme.make_job(self.volume, "acme-2"))

    def test_names_do_not_tell_how_many_jobs_others_have(self):
        stub = service_grpc.SkeletonizationServiceStub(self.lab.channel)
        accepted = next(stub.Skeletonize(example.requests(example.torus()))).accepted
        self.assertFalse(accepted.durable)
        for name in (accepted.job, self.job):
            self.assertRegex(name, "^jobs/[0-9a-f]{32}$")


if __name__ == "__main__":
    unittest.main()
