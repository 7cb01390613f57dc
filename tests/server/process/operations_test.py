"""Running the real server: settings, listeners, metrics, health under load, the operator's commands."""

import contextlib
import json
import os
import pathlib
import re
import resource
import select
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest

import grpc

import server_process
from interface import (CallTest, Code, HeldBack, connect, example, service, service_grpc, services,
                       torus_loops, torus_loops_at)
from server_process import ServerProcess, health, new_token

CLI = os.environ.get("BCCSKEL", "")
CONNECTIONS = 300
SPARE_FILES = 50  # more than a call needs
SILENT_SCRAPERS = 8


def command(*arguments, environment=None):
    return subprocess.run([CLI, *arguments], capture_output=True, text=True, check=False,
                          timeout=server_process.TIMEOUT_S, env={**os.environ, **(environment or {})})


def check_config(*flags, environment=None, file=None):
    """The exit code, the settings that are printed with their origin, and the complaints."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as config:
        config.write(file or "")
        config.flush()
        ended = subprocess.run(
            [server_process.BINARY, "--check-config", "--config", config.name, *flags],
            capture_output=True, text=True, check=False, timeout=server_process.TIMEOUT_S,
            env={**os.environ, **(environment or {})})
    lines = re.findall(r"^(\S+) = (.*)  # (.*)$", ended.stdout, re.MULTILINE)
    return ended.returncode, {name: (value, origin) for name, value, origin in lines}, ended.stderr


class SettingsTest(unittest.TestCase):
    def test_flags_beat_the_environment_and_that_beats_the_file(self):
        code, settings, errors = check_config(
            "--max-jobs", "2",
            environment={"BCCSKEL_MAX_JOBS": "3", "BCCSKEL_THREADS": "4",
                         "BCCSKEL_LISTEN": "127.0.0.1:1,unix:/run/x",
                         "BCCSKEL_DATA_DIR": "/srv/a,b"},
            file='max-jobs = 5\nthreads = 6\nmax-queue = 7\nlog-level = "error"\n')
        self.assertEqual((code, errors), (0, ""))
        self.assertEqual(settings["max-jobs"], ("2", "command line"))
        self.assertEqual(settings["threads"], ("4", "environment"))
        self.assertEqual(settings["listen"], ('["127.0.0.1:1", "unix:/run/x"]', "environment"))
        self.assertEqual(settings["data-dir"], ('"/srv/a,b"', "environment"))
        self.assertEqual(settings["max-queue"], ("7", "file"))
        self.assertEqual(settings["log-level"], ('"error"', "file"))
        self.assertEqual(settings["drain-ms"], ("25000", "default"))
        self.assertEqual(settings["keep-results"], ("168", "default"))

    def test_what_is_printed_can_be_read_as_a_file(self):
        printed = check_config("--listen", "127.0.0.1:1", "--listen", "unix:/run/x",
                               "--max-memory-bytes", "8GB", "--data-dir", 'a "quoted" \\path')[1]
        again = check_config(file="\n".join(f"{name} = {value}  # text"
                                            for name, (value, _) in printed.items()))
        self.assertEqual((again[0], again[2]), (0, ""))
        self.assertEqual({name: value for name, (value, _) in again[1].items()},
                         {name: value for name, (value, _) in printed.items()})

    def test_every_problem_is_named_with_its_value_and_its_limit(self):
        code, _, errors = check_config(
            "--threads", "0", "--data-dir", "", environment={"BCCSKEL_DRAIN_MS": "soon"},
            file='max-queue = -1\nkeep-uploads = 0x10\nthredas = 2\ntokens = "/no/such/file"\n[store]\nx = 1\ny = 2\n')
        self.assertEqual(code, 2)
        for complaint in ("--threads: 0: must be a number from 1 to 4096",
                          "BCCSKEL_DRAIN_MS: soon: must be a number from 0 to 86400000",
                          "max-queue: -1: must be a number from 0 to 1000000",
                          "keep-uploads: 0x10: must be a decimal number from 0.01 to 8784",
                          "--data-dir: is empty: give a PATH or leave it out",
                          "thredas: there is no such setting",
                          "[store]: the file must hold no sections; write its settings above",
                          "--tokens: /no/such/file: cannot be read: No such file or directory"):
            self.assertIn(complaint, errors)
        self.assertEqual(len(errors.splitlines()), 8)

    def test_a_folder_is_no_settings_file(self):
        ended = server_process.run_to_end("--check-config", "--config", tempfile.gettempdir())
        self.assertEqual(ended.returncode, 2)
        self.assertIn(f"--config: {tempfile.gettempdir()}: cannot be read", ended.stderr)


class ListenersTest(CallTest):
    def test_each_address_is_listened_on(self):
        with tempfile.TemporaryDirectory() as folder:
            second = f"unix:{folder}/server.sock"
            with ServerProcess("--listen", second) as server:
                self.assertEqual(server.line_after("listening on "), second)
                for address in (server.address, second):
                    self.assertEqual(torus_loops_at(address), 1)

    def test_reflection_and_admin_calls_move_to_the_listener_for_admins(self):
        with ServerProcess("--admin-listen", "127.0.0.1:0") as server:
            address = server.line_after("listening for admins on ")
            reflection = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo"
            status = "/bccskel.v1.AdminService/GetServerStatus"
            for where, expected in ((server.address, Code.UNIMPLEMENTED),
                                    (address, Code.OK)):
                with grpc.insecure_channel(where) as channel:
                    self.assertEqual(health(channel), 1)
                    for method, request in ((reflection, b"\x3a\x01*"), (status, b"")):
                        call = channel.stream_stream(method)(iter([request]),
                                                             timeout=server_process.TIMEOUT_S)
                        with contextlib.suppress(grpc.RpcError):
                            list(call)
                        self.assertEqual(call.code(), expected, (where, method))

    def test_an_address_that_is_open_to_a_network_has_no_admin_calls(self):
        with ServerProcess(listen="0.0.0.0:0") as server:
            with grpc.insecure_channel(server.address.replace("0.0.0.0", "127.0.0.1")) as channel:
                status = channel.unary_unary("/bccskel.v1.AdminService/GetServerStatus")
                self.fails(Code.UNIMPLEMENTED, None,
                           lambda: status(b"", timeout=server_process.TIMEOUT_S))


class MetricsTest(CallTest):
    def test_the_page_says_what_the_server_did(self):
        with ServerProcess("--metrics-listen", "127.0.0.1:0", "--threads", "2") as server:
            page = server.line_after("metrics at ")
            with grpc.insecure_channel(server.address) as channel:
                points = example.skeletonize(channel, example.torus()).summary.object_points
                stub = service_grpc.SkeletonizationServiceStub(channel)
                self.fails(Code.INVALID_ARGUMENT, "FIELD_INVALID",
                           lambda: list(stub.Skeletonize(iter([service.SkeletonizeRequest()]))))
            lines = server_process.metrics_after(page, 2, "bccskel_calls_total")
        method = 'method="/bccskel.v1.SkeletonizationService/Skeletonize"'
        for name, value in {
                f'bccskel_calls_total{{code="OK",{method},reason=""}}': 1,
                f'bccskel_calls_total{{code="INVALID_ARGUMENT",{method},reason="FIELD_INVALID"}}': 1,
                f'bccskel_call_seconds_count{{{method}}}': 2,
                'bccskel_jobs_total{code="OK",reason="",tenant="default"}': 1,
                "bccskel_job_queue_seconds_count": 1,
                "bccskel_job_decode_seconds_count": 1,
                "bccskel_job_compute_seconds_count": 1,
                "bccskel_points_thinned_total": points,
                "bccskel_jobs_waiting": 0,
                "bccskel_jobs_running": 0,
                "bccskel_threads": 2,
                "bccskel_draining": 0}.items():
            self.assertEqual(float(lines.get(name, "nan")), value, name)
        for name in ("bccskel_volume_bytes_admitted_total", "bccskel_memory_limit_bytes",
                     "process_resident_memory_bytes", "process_open_fds", "process_max_fds",
                     "process_cpu_seconds_total", "process_start_time_seconds"):
            self.assertGreater(float(lines[name]), 0, name)
        self.assertTrue(any(name.startswith("bccskel_build_info{") for name in lines))

    def test_a_volume_of_another_size_than_declared_counts_as_one(self):
        with ServerProcess("--metrics-listen", "127.0.0.1:0") as server:
            page = server.line_after("metrics at ")
            with grpc.insecure_channel(server.address) as channel:
                stub = service_grpc.SkeletonizationServiceStub(channel)
                config, chunk, finish = example.requests(example.torus())
                more = service.SkeletonizeRequest(chunk=example.volume_pb2.VolumeChunk(
                    offset=len(chunk.chunk.data), data=b"x"))
                for requests in ([config, chunk, more, finish], [config, finish]):
                    self.fails(Code.INVALID_ARGUMENT, "VOLUME_SIZE",
                               lambda: list(stub.Skeletonize(iter(requests))))
                name = ('bccskel_jobs_total{code="INVALID_ARGUMENT",reason="VOLUME_SIZE",'
                        'tenant="default"}')
                lines = server_process.metrics_after(page, 2)
        self.assertEqual(lines.get(name), "2",
                         {name: value for name, value in lines.items() if "jobs_total" in name})

    def test_jobs_that_callers_and_deadlines_end_count_as_such(self):
        with ServerProcess("--metrics-listen", "127.0.0.1:0") as server:
            page = server.line_after("metrics at ")
            with grpc.insecure_channel(server.address) as channel:
                stub = service_grpc.SkeletonizationServiceStub(channel)
                for timeout, code in ((server_process.TIMEOUT_S, Code.CANCELLED),
                                      (0.5, Code.DEADLINE_EXCEEDED)):
                    requests = HeldBack(example.requests(example.torus()))
                    replies = stub.Skeletonize(iter(requests), timeout=timeout)
                    self.assertTrue(next(replies).HasField("accepted"))
                    if code == Code.CANCELLED:
                        replies.cancel()
                    self.assertEqual(replies.code(), code)
                    requests.let_go()
                lines = server_process.metrics_after(page, 2)
        jobs = {name: value for name, value in lines.items() if name.startswith("bccskel_jobs_total")}
        # The end of a call whose deadline has passed may come to the server as its cancelling.
        ended = sum(float(value) for name, value in jobs.items()
                    if 'code="CANCELLED"' in name or 'code="DEADLINE_EXCEEDED"' in name)
        self.assertEqual(ended, 2, jobs)

    def test_methods_that_callers_make_up_share_one_series(self):
        with ServerProcess("--metrics-listen", "127.0.0.1:0") as server:
            page = server.line_after("metrics at ")
            with grpc.insecure_channel(server.address) as channel:
                self.assertEqual(health(channel), 1)
                for method in ("/made.up/First", "/bccskel.v1.JobService/Second", "/third/"):
                    with self.assertRaises(grpc.RpcError):
                        channel.unary_unary(method)(b"", timeout=server_process.TIMEOUT_S)
            lines = server_process.metrics_after(page, 4, "bccskel_calls_total")
        calls = {name: value for name, value in lines.items()
                 if name.startswith("bccskel_calls_total") and value != "0"}
        self.assertEqual(calls, {
            'bccskel_calls_total{code="OK",method="/grpc.health.v1.Health/Check",reason=""}': "1",
            'bccskel_calls_total{code="UNIMPLEMENTED",method="unknown",reason=""}': "3"})

    def test_connections_that_ask_for_nothing_keep_no_scraper_waiting(self):
        with ServerProcess("--metrics-listen", "127.0.0.1:0") as server, \
                contextlib.ExitStack() as stack:
            page = server.line_after("metrics at ")
            host, port = page.split("/")[2].split(":")
            silent = [stack.enter_context(socket.create_connection((host, int(port))))
                      for _ in range(SILENT_SCRAPERS)]
            for connection in silent:
                connection.send(b"GET /met")
            self.assertIn("bccskel_threads", server_process.metrics(page))
            still_open = [connection for connection in silent
                          if not select.select([connection], [], [], 0)[0]]
        # None of them had to give up first.
        self.assertEqual(len(still_open), SILENT_SCRAPERS)


class LoadTest(unittest.TestCase):
    def test_health_is_answered_and_sigterm_obeyed_while_all_threads_compute(self):
        with ServerProcess("--threads", "2", "--max-jobs", "2") as server:
            stop = threading.Event()
            codes = []

            def keep_busy():
                with grpc.insecure_channel(server.address) as channel:
                    while not stop.is_set():
                        try:
                            example.skeletonize(channel, example.torus())
                        except grpc.RpcError as error:
                            codes.append(error.code())
                            return

            threads = [threading.Thread(target=keep_busy) for _ in range(4)]
            for thread in threads:
                thread.start()
            with grpc.insecure_channel(server.address) as channel:
                for _ in range(20):
                    self.assertEqual(health(channel), 1)
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(server.process.wait(server_process.TIMEOUT_S), 0)
            stop.set()
            for thread in threads:
                thread.join()
        # Who had a job got its skeleton; the next call was refused as one to try again. (CANCELLED is
        # gRPC's word for calls that reach a server in its last moment.)
        self.assertLessEqual(set(codes), {Code.UNAVAILABLE, Code.CANCELLED})

    def test_idle_connections_keep_nobody_out(self):
        with ServerProcess() as server, contextlib.ExitStack() as idle:
            host, port = server.address.rsplit(":", 1)
            for number in range(CONNECTIONS):
                connection = idle.enter_context(socket.create_connection((host, int(port))))
                # Half of them say nothing, half begin to speak HTTP/2 and stop.
                if number % 2 == 1:
                    connection.sendall(b"PRI * HTTP/2.0\r\n"[:number % 16])
            self.assertEqual(torus_loops_at(server.address), 1)
            with grpc.insecure_channel(server.address) as channel:
                self.assertEqual(health(channel), 1)

    def test_connections_beyond_the_limit_of_open_files_wait_and_then_go_on(self):
        with ServerProcess() as server:
            host, port = server.address.rsplit(":", 1)
            # How many files it has open by itself depends on the machine's processors.
            limit = len(os.listdir(f"/proc/{server.process.pid}/fd")) + SPARE_FILES
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (limit, limit))
            with contextlib.ExitStack() as idle:
                for _ in range(2 * SPARE_FILES):
                    idle.enter_context(socket.create_connection((host, int(port))))
                server.wait_for_event("connections wait")
            self.assertEqual(torus_loops_at(server.address), 1)
            self.assertEqual(server.stop(), 0)
            self.assertIn("connections are accepted again", server.log_text())


class StopTest(unittest.TestCase):
    def test_sigterm_is_told_by_health_before_the_lame_duck_time_and_the_end(self):
        lame_duck_s = 2.0
        names = ["", *(descriptor.full_name for descriptor in services())]
        self.assertGreaterEqual(len(names), 6)
        with ServerProcess("--lame-duck-ms", str(int(1000 * lame_duck_s))) as server, \
                grpc.insecure_channel(server.address) as channel:
            self.assertEqual([health(channel, name) for name in names], [1] * len(names))
            start = time.monotonic()
            server.process.send_signal(signal.SIGTERM)
            while health(channel) == 1:  # the test's time limit ends it
                time.sleep(0.01)
            with connect(server.address) as later:  # told, too, and not left without answer
                self.assertEqual([health(later, name) for name in names], [2] * len(names))
                # Balancers that have not asked yet still send calls here: they are served.
                self.assertEqual(torus_loops(later), 1)
            self.assertEqual(server.process.wait(server_process.TIMEOUT_S), 0)
            self.assertGreaterEqual(time.monotonic() - start, lame_duck_s)

    def test_after_the_lame_duck_time_new_calls_are_refused_and_begun_ones_go_on(self):
        with ServerProcess("--lame-duck-ms", "300") as server, \
                grpc.insecure_channel(server.address) as channel:
            requests = HeldBack(example.requests(example.torus()))
            stub = service_grpc.SkeletonizationServiceStub(channel)
            replies = stub.Skeletonize(iter(requests))
            self.assertTrue(next(replies).HasField("accepted"))
            server.process.send_signal(signal.SIGTERM)
            reason = None
            while reason is None:  # the test's time limit ends it
                try:
                    example.skeletonize(channel, example.torus())
                except grpc.RpcError as error:
                    reason = example.error_reason(error)
            self.assertEqual(reason, "DRAINING")
            requests.let_go()
            self.assertTrue(list(replies)[-1].HasField("summary"))
            self.assertEqual(server.process.wait(server_process.TIMEOUT_S), 0)


@unittest.skipUnless(CLI, "the command line is not built")
class CommandsTest(unittest.TestCase):
    def test_probe_tells_by_its_exit_code(self):
        with ServerProcess() as server:
            self.assertEqual(command("probe", "--server", server.address).returncode, 0)
            service = ("--service", "bccskel.v1.SkeletonizationService")
            self.assertEqual(command("probe", "--server", server.address, *service).returncode, 0)
            unknown = command("probe", "--server", server.address, "--service", "no.such.Service")
            self.assertEqual(unknown.returncode, 3)
            self.assertIn(": it has no service no.such.Service; without --service, probe asks for "
                          "the whole server", unknown.stderr)
            self.assertEqual(server.stop(), 0)
            self.assertEqual(command("probe", "--server", server.address).returncode, 4)

    def test_top_shows_what_the_server_did(self):
        with ServerProcess("--threads", "2") as server:
            torus_loops_at(server.address)
            shown = command("top", "--once", "--json", "--server", server.address)
            self.assertEqual(shown.returncode, 0, shown.stderr)
            status = json.loads(shown.stdout)
            self.assertEqual((status["totals"]["jobs"], status["threads"]), (1, 2))
            self.assertIn("threads", command("top", "--once", "--server", server.address).stdout)

    def test_top_shows_what_is_stored(self):
        with tempfile.TemporaryDirectory() as folder:
            data = ("--data-dir", folder + "/data", "--max-disk-bytes", "1GB")
            with ServerProcess(*data) as server:
                shown = command("top", "--once", "--json", "--server", server.address)
                stored = json.loads(shown.stdout)["stored"]
                text = command("top", "--once", "--server", server.address).stdout
        self.assertEqual(stored, {"disk_used_bytes": 0, "disk_available_bytes": 1 << 30,
                                  "uploads_unfinished": 0, "jobs_queued": 0, "jobs_running": 0})
        self.assertIn("durable     0 jobs queued, 0 running", text)
        self.assertIn("0 MiB used, 1024 MiB left", text)

    def test_top_says_where_admin_calls_are(self):
        with ServerProcess("--admin-listen", "127.0.0.1:0") as server:
            told = command("top", "--once", "--server", server.address)
        self.assertEqual(told.returncode, 3)
        self.assertIn("--admin-listen", told.stderr)

    def test_bench_server_counts_calls_for_each_combination(self):
        with ServerProcess() as server:
            ended = command("bench", "server", "--server", server.address, "--clients", "1,2",
                            "--points", "5000", "--seconds", "0.2", "--json")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            measured = json.loads(ended.stdout)["measured"]
        self.assertEqual([row["clients"] for row in measured], [1, 2])
        for row in measured:
            self.assertGreater(row["calls"], 0)
            self.assertLessEqual(row["latency_ms"]["p50"], row["latency_ms"]["p99"])
            shares = row["median_ms"]
            self.assertLessEqual({"encode", "upload", "decode", "thinning", "download"}, set(shares))
            self.assertGreater(shares["thinning"], 0)
            self.assertLess(shares["thinning"], row["latency_ms"]["max"])
            self.assertAlmostEqual(row["ns_per_point"],
                                   1e6 * (shares["encode"] + row["latency_ms"]["p50"]) / row["points"],
                                   delta=0.01 * row["ns_per_point"])

    def test_bench_server_measures_other_shapes_and_methods(self):
        with ServerProcess() as server:
            cleaned = []
            for method in "directional", "symmetric":
                ended = command("bench", "server", "--server", server.address, "--clients", "1",
                                "--points", "5000", "--seconds", "0.2", "--json",
                                "--shape", "horse", "--method", method)
                self.assertEqual(ended.returncode, 0, ended.stderr)
                cleaned.append(json.loads(ended.stdout)["measured"][0]["median_ms"]["cleanup"])
        # Directional passes leave something to clean up.
        self.assertGreater(cleaned[0], 0)
        self.assertEqual(cleaned[1], 0)

    def test_every_command_with_a_server_takes_a_token_from_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            token, line = new_token("ops")
            (folder / "tokens").write_text(line + " admin\n")
            (folder / "token").write_text(token + "\n")
            volume = str(folder / "torus.exr")
            self.assertEqual(command("generate", "torus", "--points", "5000", "-o", volume)
                             .returncode, 0)
            with ServerProcess("--tokens", str(folder / "tokens")) as server:
                for words in (("top", "--once"), ("bench", "server", "--clients", "1", "--points",
                                                  "5000", "--seconds", "0.1"),
                              ("submit", volume, "-o", str(folder / "torus.json"))):
                    where = (*words, "--server", server.address)
                    self.assertEqual(command(*where).returncode, 9, words)
                    flag = command(*where, "--token-file", str(folder / "token"))
                    self.assertEqual(flag.returncode, 0, flag.stderr)
                    self.assertNotIn(token, flag.stdout + flag.stderr)
                    variable = command(*where, environment={
                        "BCCSKEL_TOKEN_FILE": str(folder / "token")})
                    self.assertEqual(variable.returncode, 0, variable.stderr)
            refused = command("top", "--once", "--server", "203.0.113.1:1", "--token-file",
                              str(folder / "token"))
            self.assertEqual(refused.returncode, 3)
            self.assertIn("in the clear", refused.stderr)


if __name__ == "__main__":
    unittest.main()
