"""Certificates for tests, made with openssl(1)."""

import subprocess

NEW_KEY = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]


def openssl(*arguments):
    subprocess.run(["openssl", *map(str, arguments)], check=True, capture_output=True)


class Pair:
    """A certificate and its key."""

    def __init__(self, folder, name):
        self.certificate = folder / f"{name}.pem"
        self.key = folder / f"{name}-key.pem"

    def bytes(self):
        return self.key.read_bytes(), self.certificate.read_bytes()


class Authority:
    """Signs certificates."""

    def __init__(self, folder, name):
        self.folder, self.name = folder, name
        self.pair = Pair(folder, name)
        openssl("req", "-x509", *NEW_KEY, "-days", 2, "-subj", f"/CN={name}",
                "-keyout", self.pair.key, "-out", self.pair.certificate)

    def certificate_bytes(self):
        return self.pair.certificate.read_bytes()

    def issue(self, name, days=1, folder=None):
        """A certificate for this machine; one of 0 days has expired a second later."""
        pair = Pair(folder or self.folder, name)
        request = self.folder / f"{name}.csr"
        openssl("req", "-new", *NEW_KEY, "-subj", f"/CN={name}",
                "-addext", "subjectAltName=IP:127.0.0.1,DNS:localhost",
                "-keyout", pair.key, "-out", request)
        openssl("x509", "-req", "-in", request, "-days", days, "-copy_extensions", "copy",
                "-CA", self.pair.certificate, "-CAkey", self.pair.key, "-CAcreateserial",
                "-out", pair.certificate)
        return pair
