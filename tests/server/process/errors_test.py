"""What the calls about durable things say when they are asked for something wrong."""

import unittest

import server_process
from durable_case import DurableTest, volume
from interface import Code, details, durable, jobs, services, volume_pb2, volumes


def field_of(error):
    """The field that BadRequest names."""
    trailer = dict(error.trailing_metadata())["grpc-status-details-bin"]
    for detail in details.Status.FromString(trailer).details:
        if detail.type_url.endswith("/google.rpc.BadRequest"):
            return details.BadRequest.FromString(detail.value).field_violations[0].field
    return None


class ErrorsTest(DurableTest):
    def setUp(self):
        super().setUp()
        self.start()
        self.declaration, self.data = volume()
        self.name = durable.send_volume(self.channel, self.declaration, self.data)

    def field_is_wrong(self, field, call):
        error = self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID", call)
        self.assertEqual(field_of(error), field)

    def test_wrong_fields_are_named_as_the_request_names_them(self):
        self.field_is_wrong("page_token", lambda: self.jobs.ListJobs(
            jobs.ListJobsRequest(page_token="nonsense")))
        self.field_is_wrong("threads", lambda: self.create(self.name, threads=-1))
        self.field_is_wrong("volume", lambda: self.create(""))
        self.field_is_wrong("config.upload", lambda: self.upload(volumes.UploadVolumeConfig(
            upload="uploads/a b", volume=self.declaration)))

    def test_bytes_that_are_no_message_are_told_as_such_by_every_method_that_reads_one(self):
        wrong = b"\x0a\xff"  # a field that is longer than what comes
        called = 0
        for descriptor in services():
            for method in descriptor.methods:
                if method.client_streaming:
                    continue
                called += 1
                call = self.channel.unary_stream(f"/{descriptor.full_name}/{method.name}")
                error = self.fails(Code.INVALID_ARGUMENT, "REQUEST_MALFORMED",
                                   lambda: list(call(wrong, timeout=server_process.TIMEOUT_S)))
                self.assertIn("cannot be parsed", error.details())
        self.assertGreaterEqual(called, 10)

    def test_what_can_be_no_name_is_a_wrong_field(self):
        for name in ("", "jobs/" + "x" * 200):
            self.field_is_wrong("job", lambda: self.get(name))
            self.field_is_wrong("job", lambda: self.jobs.CancelJob(jobs.CancelJobRequest(job=name)))
            self.field_is_wrong("job", lambda: self.jobs.DeleteJob(jobs.DeleteJobRequest(job=name)))
            self.field_is_wrong("job", lambda: list(self.jobs.WatchJob(
                jobs.WatchJobRequest(job=name))))
            self.field_is_wrong("job", lambda: list(self.jobs.ReadSkeleton(
                jobs.ReadSkeletonRequest(job=name))))
        self.field_is_wrong("upload", lambda: self.volumes.GetUploadStatus(
            volumes.GetUploadStatusRequest()))
        self.field_is_wrong("upload", lambda: self.volumes.DeleteUpload(
            volumes.DeleteUploadRequest()))
        self.field_is_wrong("volume", lambda: self.volumes.DeleteVolume(
            volumes.DeleteVolumeRequest()))

    def test_a_piece_beyond_the_end_is_told_as_one(self):
        job = self.create(self.name).name
        self.finish(job)
        pieces = self.get(job).result_pieces
        for index in (pieces, pieces + 1):
            error = self.fails(Code.OUT_OF_RANGE, "PIECE_INDEX", lambda: list(
                self.jobs.ReadSkeleton(jobs.ReadSkeletonRequest(job=job, piece_index=index))))
            self.assertIn("piece", error.details())

    def upload(self, config, *more):
        return self.volumes.UploadVolume(iter([volumes.UploadVolumeRequest(config=config), *more]))

    def test_an_upload_that_is_finished_takes_no_chunk_wherever_it_begins(self):
        config = volumes.UploadVolumeConfig(upload="uploads/whole", volume=self.declaration)
        finish = volumes.UploadVolumeRequest(finish=volume_pb2.VolumeFinish(
            size_bytes=len(self.data)))
        chunk = volumes.UploadVolumeRequest(chunk=volume_pb2.VolumeChunk(data=self.data))
        self.assertEqual(self.upload(config, chunk, finish).upload.volume, self.name)
        self.assertEqual(self.upload(config, finish).upload.volume, self.name)
        self.fails(Code.FAILED_PRECONDITION, "UPLOAD_FINISHED", lambda: self.upload(config, chunk))
        chunk.chunk.offset = len(self.data)
        self.fails(Code.FAILED_PRECONDITION, "UPLOAD_FINISHED", lambda: self.upload(config, chunk))

    def test_an_upload_without_any_request_is_out_of_order(self):
        self.fails(Code.INVALID_ARGUMENT, "REQUEST_ORDER",
                   lambda: self.volumes.UploadVolume(iter([])))

    def test_a_request_id_that_was_used_names_its_job(self):
        made = self.create(self.name, "once")
        error = self.fails(Code.ALREADY_EXISTS, "REQUEST_ID_REUSED",
                           lambda: self.create(self.name, "once", threads=1))
        self.assertIn(made.name, error.details())

    def test_the_time_of_a_job_is_the_same_at_once_and_later_and_none_for_what_was_not_made(self):
        checked = self.create(self.name, validate_only=True)
        self.assertFalse(checked.HasField("create_time"))
        made = self.create(self.name)
        self.assertEqual(made.create_time, self.get(made.name).create_time)


if __name__ == "__main__":
    unittest.main()
