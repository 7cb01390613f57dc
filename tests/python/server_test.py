"""The client has the functions of the package and gives the same results."""

import os
import pickle
import subprocess
import sys

import bccskel
import harness
import numpy

from certificates import Authority
from shapes import box_mesh, crossing_bars


class ServerTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        server = harness.Server(self.folder)
        self.enterContext(server)
        self.client = bccskel.Client(server.address)

    def test_masks(self):
        reports = []
        options = dict(spacing=(3, 2, 1), method="directional", pruning="none", root="node:1")
        there = self.client.skeletonize(crossing_bars(), **options,
                                        progress=lambda *report: reports.append(report))
        here = bccskel.skeletonize(crossing_bars(), **options)
        self.assertEqual(there.sha256, here.sha256)
        self.assertEqual(there.certificate, here.certificate)
        self.assertEqual(*reports[-1])
        for name in ("a.vtp", "a.bccb", "a.svg"):
            there.save(self.path("there-" + name))
            here.save(self.path("here-" + name))
            self.assertEqual((self.folder / ("there-" + name)).read_bytes(),
                             (self.folder / ("here-" + name)).read_bytes())

    def test_meshes(self):
        self.assertEqual(self.client.skeletonize_mesh(*box_mesh(), points=2000).sha256,
                         bccskel.skeletonize_mesh(*box_mesh(), points=2000).sha256)

    def test_labels(self):
        image = crossing_bars() * numpy.where(numpy.arange(50) < 25, 4, 300)
        here = bccskel.skeletonize_labels(image)
        for form in (image.astype("i2"), image.astype("f4"), image.astype(">u8"), image[::-1][::-1],
                     numpy.asfortranarray(image)):
            there = self.client.skeletonize_labels(form)
            self.assertEqual({n: (s.sha256, s.voxels) for n, s in there.items()},
                             {n: (s.sha256, s.voxels) for n, s in here.items()})
        self.assertEqual(sorted(self.client.skeletonize_labels(image, labels=[300])), [300])
        with self.assertWarnsRegex(UserWarning, "^no label has 1000000 voxels or more$"):
            self.assertEqual(self.client.skeletonize_labels(image, min_voxels=10 ** 6), {})
        with self.assertRaisesRegex(ValueError, "^no voxel has the label 7; the image has 2 labels: 4, 300$"):
            self.client.skeletonize_labels(image, labels=7)
        for value in (-1.0, 0.5, 1e20, numpy.inf):
            wrong = image.astype("f8")
            wrong[3, 2, 1] = value
            for skeletonize in (self.client.skeletonize_labels, bccskel.skeletonize_labels):
                with self.assertRaises(ValueError) as caught:
                    skeletonize(wrong)
                self.assertIn(f"voxel (3, 2, 1) is {value:g};", str(caught.exception))
        large = numpy.full((3, 3, 3), 1e19)
        self.assertEqual(list(self.client.skeletonize_labels(large)), [10 ** 19])
        there[4].save(self.path("four.swc"))
        for name in ("four.html", "four.exr"):
            with self.assertRaises(NotImplementedError):
                there[4].save(self.path(name))
        with self.assertRaises(NotImplementedError):
            self.client.skeletonize_labels(image, sampling="nearest")

    def test_nothing(self):
        numpy.save(self.path("nothing.npy"), numpy.zeros((4, 5, 6)))
        harness.bccskel("voxelize", self.path("nothing.npy"), "-o", self.path("nothing.bccb"))
        lattice = bccskel.read(self.path("nothing.bccb"))
        for nothing in (numpy.zeros((4, 5, 6)), numpy.full((1, 1, 1), numpy.nan), lattice):
            found = []
            for skeletonize in (self.client.skeletonize, bccskel.skeletonize):
                with self.assertWarnsRegex(UserWarning, "the object has no points"):
                    found.append(skeletonize(nothing))
            there, here = found
            self.assertEqual((there.sha256, there.certificate, there.notes),
                             (here.sha256, here.certificate, here.notes))
            self.assertEqual(len(there.nodes), 0)
        self.assertEqual(self.client.skeletonize_labels(numpy.zeros((4, 5, 6), "u1")), {})

    def test_descriptions(self):
        self.assertEqual(self.client.describe()["server_version"], bccskel.__version__)


class TlsTest(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.ours, self.theirs = (Authority(self.folder, name) for name in ("ours", "theirs"))
        self.pair = self.ours.issue("server")

    def serve(self, *words):
        server = harness.Server(self.folder, "--tls-cert", str(self.pair.certificate), "--tls-key",
                                str(self.pair.key), *words, listen="127.0.0.1:0")
        return self.enterContext(server).address

    def test_who_trusts_the_authority_of_the_server_reaches_it(self):
        address = self.serve()
        client = bccskel.Client(address, tls=self.ours.pair.certificate)
        self.assertEqual(client.skeletonize(crossing_bars()).sha256,
                         bccskel.skeletonize(crossing_bars()).sha256)
        self.assertEqual(client.describe()["server_version"], bccskel.__version__)
        for tls in (self.theirs.pair.certificate, True, None):
            with self.assertRaises((ConnectionError, TimeoutError)):
                bccskel.Client(address, tls=tls).describe(timeout=5)

    def test_who_does_not_reach_a_server_learns_why(self):
        ours, theirs = self.ours.pair.certificate, self.theirs.pair.certificate
        plain = self.enterContext(harness.Server(self.folder, listen="127.0.0.1:0")).address
        encrypted = self.serve()
        for address, tls, why in (
                (plain, ours, "it has no TLS: omit tls= if the network is trusted$"),
                (encrypted, theirs, "give the authority that signed its certificate as tls=$"),
                (encrypted, None, "if it wants TLS, give tls= to Client$")):
            with self.assertRaisesRegex(ConnectionError, f"^server {address}: .*; {why}"):
                bccskel.Client(address, tls=tls).skeletonize(numpy.ones((3, 3, 3)), timeout=20)

    def test_errors_of_connections_are_all_that_is_told(self):
        address = self.serve()
        call = (f"import bccskel, numpy; bccskel.Client({address!r}, tls="
                f"{str(self.theirs.pair.certificate)!r}).skeletonize(numpy.ones((3, 3, 3)))")
        for verbosity, silent in (({}, True), ({"GRPC_VERBOSITY": "ERROR"}, False)):
            environment = {name: value for name, value in os.environ.items()
                           if name != "GRPC_VERBOSITY"}
            done = subprocess.run([sys.executable, "-c", call], capture_output=True, text=True,
                                  env={**environment, **verbosity})
            self.assertIn("ConnectionError", done.stderr)
            self.assertEqual("Handshake failed" not in done.stderr, silent, done.stderr)

    def test_a_client_shows_a_certificate_and_a_token(self):
        authority = self.ours.pair.certificate
        made = subprocess.run([harness.SERVER, "--new-token", "ann"], capture_output=True,
                              text=True, check=True)
        token, line = made.stdout.splitlines()
        (self.folder / "tokens").write_text(line + "\n")
        address = self.serve("--tls-client-ca", str(authority), "--tokens", self.path("tokens"))
        mine, others = self.ours.issue("ann"), self.theirs.issue("eve")

        def describe(pair, **words):
            tls = (authority, pair.certificate, pair.key) if pair else authority
            return bccskel.Client(address, tls=tls, **words).describe(timeout=10)

        self.assertIn("algorithm_version", describe(mine, token=token))
        self.assertIn("algorithm_version", describe(mine, token=f" {token}\r\n"))
        with self.assertRaises(PermissionError):
            describe(mine, token=token[::-1])
        with self.assertRaisesRegex(PermissionError, "give token= to Client"):
            describe(mine)
        with self.assertRaisesRegex(PermissionError, "give token= to Client"):
            bccskel.Client(address, tls=(authority, mine.certificate, mine.key)).skeletonize(
                crossing_bars(), timeout=20)
        for pair in (others, None):
            with self.assertRaises((ConnectionError, TimeoutError)):
                describe(pair, token=token)


class RefusalsTest(harness.TestCase):
    def test_no_server(self):
        with self.assertRaisesRegex(TypeError, "a Client holds a connection and cannot be pickled: "):
            pickle.dumps(bccskel.Client("unix:/nowhere"))
        for address in (f"unix:{self.folder}/none", "127.0.0.1:1"):
            message = f"^server {address}: .*; start bccskel-server there$"
            with self.assertRaisesRegex(ConnectionError, message):
                bccskel.Client(address).skeletonize(numpy.ones((3, 3, 3)), timeout=20)

    def test_tokens(self):
        with self.assertRaisesRegex(ValueError, "token.* tls=.* plaintext_token=True"):
            bccskel.Client("example.org:1", token="secret")
        for token in ("secr\u00e9t", "secret\nsecret", "secret\0", "\ud800secret", "\n"):
            with self.assertRaisesRegex(ValueError, "token") as raised:
                bccskel.Client("unix:/nowhere", token=token)
            self.assertNotIn("secr", str(raised.exception))
        for words in ({"address": 5, "token": "secret"}, {"token": b"secret"},
                      {"address": "\ud800", "token": "secret"},
                      {"token": "secret", "plaintext_token": "yes"}):
            with self.assertRaises((TypeError, ValueError)) as raised:
                bccskel.Client(**words)
            self.assertNotIn("secr", str(raised.exception))
        with self.assertRaises(FileNotFoundError):
            bccskel.Client(tls=self.path("none.pem"))
        with self.assertRaisesRegex(ValueError, "tls must be"):
            bccskel.Client(tls=("a", "b"))
        with open(self.path("empty.pem"), "wb"), \
                self.assertRaisesRegex(ValueError, "empty.pem: is empty$"):
            bccskel.Client("example.org:1", tls=self.path("empty.pem"))

    def test_timeouts(self):
        for timeout in (0, -5, float("nan"), 1e300, "5"):
            with self.assertRaisesRegex(ValueError, "timeout must be a positive number"):
                bccskel.Client("127.0.0.1:1").describe(timeout=timeout)


if __name__ == "__main__":
    harness.main()
