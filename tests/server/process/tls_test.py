"""TLS and mTLS of the real server: who is let in, and certificates that change meanwhile."""

import os
import pathlib
import shutil
import socket
import ssl
import subprocess
import tempfile
import time
import unittest

import grpc

import server_process
from certificates import Authority, Pair
from interface import HeldBack, example, service_grpc, torus_loops
from server_process import ServerProcess, new_token, run_to_end

CLI = os.environ.get("BCCSKEL", "")


def outcome(address, credentials):
    """OK, or the code of the failure, of a call over a connection of its own."""
    options = [("grpc.use_local_subchannel_pool", 1)]
    with (grpc.secure_channel(address, credentials, options) if credentials else
          grpc.insecure_channel(address, options)) as channel:
        try:
            return grpc.StatusCode.OK if torus_loops(channel) == 1 else None
        except grpc.RpcError as error:
            return error.code()


def shown_certificate(address):
    """What the server shows in a handshake."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    context.set_alpn_protocols(["h2"])
    host, port = address.rsplit(":", 1)
    with socket.create_connection((host, int(port))) as plain:
        with context.wrap_socket(plain) as secure:
            return ssl.DER_cert_to_PEM_cert(secure.getpeercert(binary_form=True))


class TlsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.ours = Authority(cls.folder, "ours")
        cls.theirs = Authority(cls.folder, "theirs")
        cls.pair = cls.ours.issue("server")
        cls.root = cls.ours.certificate_bytes()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def flags(self, pair=None):
        pair = pair or self.pair
        return "--tls-cert", str(pair.certificate), "--tls-key", str(pair.key)

    def test_only_who_trusts_the_right_authority_talks_to_the_server(self):
        with ServerProcess(*self.flags()) as server:
            ours = grpc.ssl_channel_credentials(self.root)
            theirs = grpc.ssl_channel_credentials(self.theirs.certificate_bytes())
            self.assertEqual(outcome(server.address, ours), grpc.StatusCode.OK)
            self.assertEqual(outcome(server.address, theirs), grpc.StatusCode.UNAVAILABLE)
            self.assertEqual(outcome(server.address, None), grpc.StatusCode.UNAVAILABLE)
            self.assertEqual(server.stop(), 0)

    def test_where_clients_must_show_a_certificate_a_missing_wrong_or_expired_one_is_refused(self):
        expired = self.ours.issue("expired", days=0)
        authority = str(self.ours.pair.certificate)
        with ServerProcess(*self.flags(), "--tls-client-ca", authority) as server:
            time.sleep(1.1)  # the end of `expired`
            def credentials(pair):
                return grpc.ssl_channel_credentials(self.root, *(pair.bytes() if pair else ()))
            self.assertEqual(outcome(server.address, credentials(self.ours.issue("client"))),
                             grpc.StatusCode.OK)
            for pair in (None, self.theirs.issue("stranger"), expired):
                self.assertEqual(outcome(server.address, credentials(pair)),
                                 grpc.StatusCode.UNAVAILABLE)

    def test_a_new_certificate_is_shown_while_calls_run_on(self):
        versions = []
        for number in (1, 2):
            folder = self.folder / f"v{number}"
            folder.mkdir()
            versions.append(self.ours.issue("rotating", folder=folder))
        live = self.folder / "live"
        live.symlink_to("v1")
        pair = Pair(live, "rotating")
        with ServerProcess(*self.flags(pair)) as server:
            requests = HeldBack(example.requests(example.torus()))
            credentials = grpc.ssl_channel_credentials(self.root)
            with grpc.secure_channel(server.address, credentials) as channel:
                replies = service_grpc.SkeletonizationServiceStub(channel).Skeletonize(
                    iter(requests), timeout=server_process.TIMEOUT_S)
                self.assertTrue(next(replies).HasField("accepted"))
                self.assertEqual(shown_certificate(server.address),
                                 versions[0].certificate.read_text())
                (self.folder / "next").symlink_to("v2")
                os.replace(self.folder / "next", live)  # both files at once
                end = time.monotonic() + server_process.TIMEOUT_S
                while shown_certificate(server.address) != versions[1].certificate.read_text():
                    self.assertLess(time.monotonic(), end)
                    time.sleep(0.1)
                requests.let_go()
                self.assertTrue(list(replies)[-1].HasField("summary"))
            self.assertEqual(outcome(server.address, credentials), grpc.StatusCode.OK)

    def test_another_authority_for_clients_takes_the_place_of_the_first_one(self):
        live = self.folder / "clients.pem"
        shutil.copy(self.ours.pair.certificate, live)
        ours, theirs = (grpc.ssl_channel_credentials(self.root, *authority.issue("client").bytes())
                        for authority in (self.ours, self.theirs))
        with ServerProcess(*self.flags(), "--tls-client-ca", str(live)) as server:
            self.assertEqual(outcome(server.address, ours), grpc.StatusCode.OK)
            self.assertEqual(outcome(server.address, theirs), grpc.StatusCode.UNAVAILABLE)
            shutil.copy(self.theirs.pair.certificate, self.folder / "next.pem")
            os.replace(self.folder / "next.pem", live)
            end = time.monotonic() + server_process.TIMEOUT_S
            while outcome(server.address, theirs) != grpc.StatusCode.OK:
                self.assertLess(time.monotonic(), end)
            self.assertEqual(outcome(server.address, ours), grpc.StatusCode.UNAVAILABLE)

    def test_while_a_file_is_wrong_it_is_named_and_the_certificates_before_are_served(self):
        folder = self.folder / "live_files"
        folder.mkdir()
        certificate, key, clients = (folder / name for name in ("c.pem", "k.pem", "ca.pem"))
        good = {certificate: self.pair.certificate.read_bytes(), key: self.pair.key.read_bytes(),
                clients: self.root}
        for path, data in good.items():
            path.write_bytes(data)
        credentials = grpc.ssl_channel_credentials(self.root, *self.ours.issue("client").bytes())
        with ServerProcess("--tls-cert", str(certificate), "--tls-key", str(key),
                           "--tls-client-ca", str(clients)) as server:
            def wait_for(event, complaint=""):
                while not any(event in line and complaint in line for line in server.log_text()[at:]
                              .splitlines()):
                    self.assertIsNone(server.process.poll(), server.log_text())
                    time.sleep(0.05)

            other_key = self.theirs.issue("stranger").key.read_bytes()
            for path, data, complaint in [
                    (certificate, b"", "c.pem: cannot be read as a PEM certificate"),
                    (certificate, b"rubbish", "c.pem: cannot be read as a PEM certificate"),
                    (certificate, None, "c.pem: cannot be read as a PEM certificate"),
                    (key, b"", "k.pem: cannot be read as a PEM key"),
                    (key, other_key, f"{key}: is not the key of {certificate}"),
                    (clients, b"", "ca.pem: cannot be read as PEM certificates")]:
                at = len(server.log_text())
                if data is None:
                    path.unlink()
                else:
                    path.write_bytes(data)
                wait_for("certificates not reloaded", complaint)
                self.assertEqual(outcome(server.address, credentials), grpc.StatusCode.OK, complaint)
                path.write_bytes(good[path])
                wait_for("certificates reloaded")
                self.assertEqual(outcome(server.address, credentials), grpc.StatusCode.OK, complaint)

    @unittest.skipUnless(CLI, "the command line is not built")
    def test_the_command_line_speaks_tls_and_shows_certificate_and_token(self):
        token, line = new_token("acme")
        for name, text in (("tokens", line), ("token", token)):
            (self.folder / name).write_text(text + "\n")
        client = self.ours.issue("client")
        volume, skeleton = self.folder / "torus.exr", self.folder / "torus.json"
        subprocess.run([CLI, "generate", "torus", "--points", "5000", "-o", volume], check=True,
                       capture_output=True, timeout=server_process.TIMEOUT_S)
        trusted = ("--tls-ca", self.ours.pair.certificate)
        shown = ("--tls-cert", client.certificate, "--tls-key", client.key)
        token_file = ("--token-file", self.folder / "token")

        def submit(address, *flags):
            return subprocess.run(
                [CLI, "submit", volume, "-o", skeleton, "--server", address, *flags],
                capture_output=True, text=True, timeout=server_process.TIMEOUT_S, check=False)

        for flags, tls, hint in (
                ((), trusted, "the server has no TLS: start it with --tls-cert and --tls-key"),
                (self.flags(), ("--tls-ca", self.theirs.pair.certificate),
                 "name the authority that signed the server's certificate with --tls-ca"),
                (self.flags(), (), "if the server uses TLS, name its certificate authority")):
            with ServerProcess(*flags) as server:
                lines = submit(server.address, *tls).stderr.splitlines()
                self.assertEqual(len(lines), 2, lines)  # none of gRPC's own
                self.assertTrue(lines[1].startswith("bccskel: hint: " + hint), lines)
        with ServerProcess(*self.flags(), "--tls-client-ca", str(self.ours.pair.certificate),
                           "--tokens", str(self.folder / "tokens")) as server:
            ended = submit(server.address, *trusted, *shown, *token_file)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertTrue(skeleton.stat().st_size)
            for flags in ((*trusted, *shown), (*trusted, *token_file), (*shown, *token_file),
                          ("--tls-ca", self.theirs.pair.certificate, *shown, *token_file)):
                refused = submit(server.address, "--timeout", "1", *flags)
                self.assertNotEqual(refused.returncode, 0, flags)

    def test_the_metrics_say_when_the_served_certificate_ends_whatever_the_files_hold(self):
        def end_of(pair):
            decoded = ssl._ssl._test_decode_cert(str(pair.certificate))
            return ssl.cert_time_to_seconds(decoded["notAfter"])

        def end_on_page():
            return float(server_process.metrics(page)["bccskel_certificate_not_after_seconds"])

        live, later = self.ours.issue("ending"), self.ours.issue("later", days=30)
        first_end, later_end = end_of(live), end_of(later)
        with ServerProcess(*self.flags(live), "--metrics-listen", "127.0.0.1:0") as server:
            page = server.line_after("metrics at ")
            self.assertEqual(end_on_page(), first_end)
            os.replace(later.certificate, live.certificate)  # without its key
            server.wait_for_event("certificates not reloaded")
            self.assertEqual(end_on_page(), first_end)
            os.replace(later.key, live.key)
            server.wait_for_event("certificates reloaded")
            self.assertEqual(end_on_page(), later_end)
            live.certificate.unlink()
            self.assertEqual(end_on_page(), later_end)

    def test_files_that_cannot_work_are_named_before_the_server_listens(self):
        expired = self.ours.issue("old", days=0)
        other_key = self.theirs.issue("other").key
        time.sleep(1.1)
        certificate, key = str(self.pair.certificate), str(self.pair.key)
        for flags, complaint in [
                ((certificate, str(other_key)), f"{other_key}: is not the key of {certificate}"),
                ((str(expired.certificate), str(expired.key)), "the certificate has expired"),
                (("/no/such.pem", key), "/no/such.pem: cannot be read"),
                ((certificate, certificate), f"{certificate}: cannot be read as a PEM key"),
                ((certificate, ""), "--tls-cert and --tls-key belong together")]:
            ended = run_to_end("--listen", "127.0.0.1:0", "--tls-cert", flags[0],
                               "--tls-key", flags[1])
            self.assertEqual(ended.returncode, 2, flags)
            self.assertIn(complaint, ended.stderr)


if __name__ == "__main__":
    unittest.main()
