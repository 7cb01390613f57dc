"""Tokens and tenants of the real server."""

import json
import pathlib
import tempfile
import time
import unittest

import grpc
import numpy as np

import server_process
from interface import (CallTest, Code, HeldBack, admin, admin_grpc, bearer, example, jobs,
                       jobs_grpc, service_grpc, services)
from server_process import ServerProcess, new_token, run_to_end


class TokensTest(CallTest):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.file = pathlib.Path(self.temporary.name) / "tokens"
        self.acme, acme_line = new_token("acme")
        self.lab, lab_line = new_token("lab")
        self.ops, ops_line = new_token("ops")
        self.lines = [acme_line + " weight=2 max-jobs=4", lab_line, ops_line + " admin"]
        self.write(self.lines)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, lines):
        new = self.file.with_suffix(".new")
        new.write_text("# tenants\n" + "\n".join(lines) + "\n")
        new.replace(self.file)

    def server(self, *flags):
        return ServerProcess("--tokens", str(self.file), *flags)

    def outcome(self, server, token):
        """OK, or the code and the reason of the failure."""
        with grpc.insecure_channel(server.address) as channel:
            stub = service_grpc.SkeletonizationServiceStub(channel)
            try:
                list(stub.Skeletonize(example.requests(example.torus()), metadata=bearer(token),
                                      timeout=server_process.TIMEOUT_S))
                return Code.OK
            except grpc.RpcError as error:
                return error.code(), example.error_reason(error)

    def wait_for(self, server, token, wanted):
        end = time.monotonic() + server_process.TIMEOUT_S
        while (last := self.outcome(server, token)) != wanted:
            self.assertLess(time.monotonic(), end, last)
            time.sleep(0.1)

    def test_every_method_of_every_service_wants_a_token(self):
        methods = [f"/{service.full_name}/{method.name}" for service in services()
                   for method in service.methods]
        self.assertGreaterEqual(len(methods), 16)
        with self.server() as server, grpc.insecure_channel(server.address) as channel:
            for method in methods:
                # Whether it streams makes no difference for a call that is refused at once.
                call = channel.stream_stream(method)
                with self.subTest(method):
                    self.fails(Code.UNAUTHENTICATED, "TOKEN_MISSING", lambda: list(
                        call(iter([b""]), timeout=server_process.TIMEOUT_S)))

    def test_a_token_lets_its_tenant_in_and_no_other_text_does(self):
        refused = (Code.UNAUTHENTICATED, "TOKEN_INVALID")
        with self.server() as server:
            self.assertEqual(self.outcome(server, self.acme), Code.OK)
            self.assertEqual(self.outcome(server, self.lab), Code.OK)
            for text in (self.acme[:-1], self.acme + "0", "acme", self.lines[0].split()[1], "x"):
                self.assertEqual(self.outcome(server, text), refused)

    def test_admin_calls_are_for_admins(self):
        with self.server() as server, grpc.insecure_channel(server.address) as channel:
            ask = admin_grpc.AdminServiceStub(channel).GetServerStatus
            request = admin.GetServerStatusRequest()
            self.assertEqual(ask(request, metadata=bearer(self.ops)).threads > 0, True)
            self.fails(Code.PERMISSION_DENIED, "ADMIN_ONLY",
                       lambda: ask(request, metadata=bearer(self.acme)))

    def test_the_file_is_read_again_and_a_mistake_in_it_changes_nothing(self):
        refused = (Code.UNAUTHENTICATED, "TOKEN_INVALID")
        token, line = new_token("newcomer")
        with self.server() as server:
            self.assertEqual(self.outcome(server, token), refused)
            self.write(self.lines[1:] + [line])
            self.wait_for(server, token, Code.OK)
            self.assertEqual(self.outcome(server, self.acme), refused)
            self.write(["newcomer " + "x" * 64])
            server.wait_for_event("tokens not reloaded")
            self.assertEqual(self.outcome(server, token), Code.OK)
            self.assertEqual(server.stop(), 0)

    def test_calls_under_way_end_with_their_token_and_those_of_others_go_on(self):
        with tempfile.TemporaryDirectory() as data, self.server("--data-dir", data) as server, \
                grpc.insecure_channel(server.address) as channel:
            stub = service_grpc.SkeletonizationServiceStub(channel)

            def begin(token, array):
                requests = HeldBack(example.requests(array))
                self.addCleanup(requests.let_go)
                call = stub.Skeletonize(iter(requests), metadata=bearer(token),
                                        timeout=server_process.TIMEOUT_S)
                return requests, call, next(call).accepted.job

            small, large = example.torus(), example.torus(200.0, 60.0)
            _, revoked, _ = begin(self.acme, small)
            _, durable, job = begin(self.acme, large)
            watch = jobs_grpc.JobServiceStub(channel).WatchJob(
                jobs.WatchJobRequest(job=job), metadata=bearer(self.acme),
                timeout=server_process.TIMEOUT_S)
            next(watch)
            requests, kept, _ = begin(self.lab, small)
            self.write(self.lines[1:])
            for call in (revoked, durable, watch):
                self.fails(Code.UNAUTHENTICATED, "TOKEN_INVALID", lambda: list(call))
            requests.let_go()
            self.assertTrue(list(kept)[-1].HasField("summary"))

    def test_a_call_that_nobody_reads_ends_with_its_token(self):
        noise = np.random.default_rng(1).random((2, 64, 64, 64)) < 0.35
        with self.server() as server, grpc.insecure_channel(server.address) as channel:
            unread = service_grpc.SkeletonizationServiceStub(channel).Skeletonize(
                example.requests(noise), metadata=bearer(self.acme),
                timeout=server_process.TIMEOUT_S)
            server.wait_for_event("job accepted")
            self.write(self.lines[1:])
            server.wait_for_event("call ended")
            self.assertIn('"reason":"TOKEN_INVALID"', server.log_text())
            unread.cancel()

    def test_tenants_are_told_apart_and_no_token_is_written_anywhere(self):
        trace = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"
        with self.server("--log-level", "trace", "--metrics-listen", "127.0.0.1:0") as server:
            page = server.line_after("metrics at ")
            for token in (self.acme, self.lab, "bccskel_wrong"):
                self.outcome(server, token)
            with grpc.insecure_channel(server.address) as channel:
                stub = service_grpc.SkeletonizationServiceStub(channel)
                for traceparent in (trace, f"a {self.acme} in the wrong place"):
                    list(stub.Skeletonize(
                        example.requests(example.torus()), timeout=server_process.TIMEOUT_S,
                        metadata=bearer(self.acme) + (("traceparent", traceparent),)))
            metrics = server_process.metrics_after(page, 4)
            self.assertEqual(server.stop(), 0)
            log = server.log_text()
        for tenant, jobs in (("acme", 3), ("lab", 1)):
            self.assertEqual(
                metrics[f'bccskel_jobs_total{{code="OK",reason="",tenant="{tenant}"}}'], str(jobs))
        ended = [line for line in map(json.loads, log.splitlines()) if line["event"] == "call ended"]
        # A call is logged as ended after its answer, so the next one may come first.
        self.assertCountEqual(
            [(line["tenant"], line["traceparent"]) for line in ended],
            [("acme", ""), ("lab", ""), ("", ""), ("acme", trace), ("acme", "")])
        [refused] = [line for line in ended if line["tenant"] == ""]
        self.assertEqual(refused["reason"], "TOKEN_INVALID")
        for secret in (self.acme, self.lab, self.ops, "bccskel_wrong"):
            self.assertNotIn(secret, log + str(metrics))

    def test_tokens_do_not_cross_a_network_in_the_clear(self):
        ended = run_to_end("--listen", "0.0.0.0:0", "--tokens", str(self.file))
        self.assertEqual(ended.returncode, 2)
        self.assertIn("--plaintext-tokens allow", ended.stderr)
        with ServerProcess("--tokens", str(self.file), "--plaintext-tokens", "allow",
                           listen="0.0.0.0:0") as server:
            self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    unittest.main()
