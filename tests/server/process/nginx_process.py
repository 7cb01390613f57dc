"""nginx as docker/nginx configures it, in front of servers that listen on Unix sockets."""

import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import time

NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin")
CONFIGURATION = pathlib.Path(__file__).resolve().parents[3] / "docker" / "nginx"
TIMEOUT_S = 60


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def rewrite(path, changes):
    """Replaces all of them in the file, which has them all."""
    text = path.read_text()
    for old, new in changes.items():
        assert old in text, f"{path}: no {old}"
        text = text.replace(old, new)
    path.write_text(text)


def configure(folder, server_sockets, port, pair=None):
    """The committed files, with this site's listener and upstream: with a pair of certificate and key
    the example of a listener with TLS, with several servers the upstream of a fleet of three."""
    site = folder / "nginx"
    shutil.copytree(CONFIGURATION, site)
    plain, example = site / "listeners/plain.conf", site / "listeners/tls.conf.example"
    if pair is None:
        rewrite(plain, {"listen 8080": f"listen 127.0.0.1:{port}"})
    else:
        example.rename(plain)
        rewrite(plain, {"listen 8443": f"listen 127.0.0.1:{port}",
                        "/etc/nginx/tls/tls.crt": str(pair.certificate),
                        "/etc/nginx/tls/tls.key": str(pair.key)})
    if len(server_sockets) == 1:
        rewrite(site / "upstreams/socket.conf", {"/run/bccskel/server.sock": server_sockets[0]})
    else:
        (site / "fleet/servers.conf").replace(site / "upstreams/socket.conf")
        rewrite(site / "upstreams/socket.conf",
                {f"/run/bccskel-{number}/server.sock": path
                 for number, path in enumerate(server_sockets, 1)})
    # Two of them at a time must not share the files that nginx writes.
    rewrite(site / "nginx.conf", {"/tmp/nginx": f"{folder}/written"})
    return site


def wait_for(port, process):
    end = time.monotonic() + TIMEOUT_S
    while time.monotonic() < end and process.poll() is None:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)):
            return
        time.sleep(0.02)
    raise RuntimeError("nginx does not listen")


@contextlib.contextmanager
def nginx_in_front(folder, *server_sockets, pair=None):
    """The address to call while nginx runs. `folder` is a pathlib.Path of our own; one server or a
    fleet of three."""
    port = free_port()
    site = configure(folder, server_sockets, port, pair)
    user = " user root;" if os.geteuid() == 0 else ""  # who may open the socket
    process = subprocess.Popen([NGINX, "-p", site, "-c", site / "nginx.conf", "-g",
                                f"daemon off;{user}"], stderr=subprocess.DEVNULL)
    try:
        wait_for(port, process)
        yield f"127.0.0.1:{port}"
    finally:
        process.terminate()
        process.wait(TIMEOUT_S)
