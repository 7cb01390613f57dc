#!/usr/bin/python3
"""Communication of bccskel-mpi and its cost on networks: counts, delayed runs, a model.

  ranks_report.py counts BCCSKEL_MPI    runs shapes on 1, 2, 4 and 8 ranks and prints what they sent
  ranks_report.py delay BCCSKEL_MPI     two ranks in two network namespaces, with a delay of 0, 0.1 and
                                        1 ms between them, against the model; as root
  ranks_report.py model                 the model's table for large lattices and many ranks

The delay is a relay of packets between two TUN devices, since not every kernel has `tc netem`; the
actual delay of packets is measured and printed with each run.
"""

import collections
import ctypes
import fcntl
import json
import math
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

MPIRUN = ["mpirun", "--oversubscribe"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
STAGE = re.compile(r"rank (\d+) of \d+: (\w+): (\d+) trades, (\d+) sums, (\d+) messages, "
                   r"(\d+) bytes sent, ([\d.]+) s in them")
WHOLE = re.compile(r"rank (\d+) of \d+: ([\d.]+) s of processor time, (\d+) MiB")
DIRECTIONAL = ("--method", "directional", "--distance", "chamfer")
JOBS = {"symmetric": (), "directional": DIRECTIONAL}

Stage = collections.namedtuple("Stage", "trades sums messages bytes seconds")


def run(words):
    """Runs a job; returns its result, {stage: [Stage by rank]} and [(seconds, MiB) by rank]."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "out.json"
        job = subprocess.run([*words, "-o", output, "--report-exchange"], env=ENVIRONMENT,
                             capture_output=True, text=True, check=False)
        if job.returncode != 0:
            sys.exit(job.stderr)
        result = json.loads(output.read_text())
    stages, whole = collections.defaultdict(dict), {}
    for rank, stage, *counts, seconds in STAGE.findall(job.stderr):
        stages[stage][int(rank)] = Stage(*map(int, counts), float(seconds))
    for rank, seconds, mib in WHOLE.findall(job.stderr):
        whole[int(rank)] = (float(seconds), int(mib))
    return (result, {name: [of[n] for n in sorted(of)] for name, of in stages.items()},
            [whole[n] for n in sorted(whole)])


def job_words(program, shape, points, options):
    return [program, "skeletonize", "--generate", shape, "--points", str(points), *options]


# ---- counts

def counts(program):
    print("| object | method | ranks | s of processor time, most | MiB, most | shells | synchronizations a shell |"
          " thinning: bytes sent a shell and rank | bytes sent a point: distances, thinning, rest |")
    print("|---|---|---|---|---|---|---|---|---|")
    for shape, points in (("ball", 8_000_000), ("ball", 64_000_000), ("tree", 8_000_000)):
        for name, options in JOBS.items():
            digests = set()
            for ranks in (1, 2, 4, 8):
                result, stages, whole = run([*MPIRUN, "-n", str(ranks),
                                             *job_words(program, shape, points, options)])
                digests.add(result["sha256"])
                thinning = stages["thinning"]
                shells = thinning[0].sums - 2  # one for the points before, one for the end
                sent = {stage: sum(of.bytes for of in each) for stage, each in stages.items()}
                rest = sum(sent.values()) - sent["distances"] - sent["thinning"]
                total = result["object_points"]
                print(f"| {shape} {points // 10**6}M | {name} | {ranks} "
                      f"| {max(seconds for seconds, _ in whole):.2f} | {max(m for _, m in whole)} "
                      f"| {shells} | {(thinning[0].trades + thinning[0].sums) / shells:.1f} "
                      f"| {sent['thinning'] / shells / ranks:,.0f} "
                      f"| {sent['distances'] / total:.2f}, {sent['thinning'] / total:.2f}, "
                      f"{rest / total:.2f} |", flush=True)
            assert len(digests) == 1, digests


# ---- delay

SIDES = ("ranks-a", "ranks-b")
ADDRESSES = ("10.19.7.1", "10.19.7.2")
AGENT = """#!/bin/sh
# Open MPI's way to start a daemon on another host, here in another network namespace.
shift
exec ip netns exec ranks-b unshare --uts sh -c "hostname ranks-b; $*"
"""


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def enter(side):
    with open(f"/var/run/netns/{side}" if side else "/proc/1/ns/net", encoding="ascii") as file:
        if ctypes.CDLL(None, use_errno=True).setns(file.fileno(), 0x40000000) != 0:
            raise OSError(ctypes.get_errno(), "setns")


def open_tun(side, address):
    with open("/proc/self/ns/net", encoding="ascii") as home:
        enter(side)
        tun = os.open("/dev/net/tun", os.O_RDWR)
        fcntl.ioctl(tun, 0x400454CA, struct.pack("16sH", b"wire0", 0x1001))  # TUNSETIFF: TUN, NO_PI
        ctypes.CDLL(None).setns(home.fileno(), 0x40000000)
    ip("-n", side, "addr", "add", f"{address}/24", "dev", "wire0")
    ip("-n", side, "link", "set", "dev", "wire0", "mtu", "32000", "txqueuelen", "10000", "up")
    ip("-n", side, "link", "set", "dev", "lo", "up")
    return tun


class Link:
    """Two namespaces with a wire between them on which packets take `delay` seconds."""

    def __enter__(self):
        self.delay = 0.0
        for side in SIDES:
            subprocess.run(["ip", "netns", "del", side], stderr=subprocess.DEVNULL, check=False)
            ip("netns", "add", side)
        tuns = [open_tun(*each) for each in zip(SIDES, ADDRESSES)]
        for source, target in (tuns, tuns[::-1]):
            queue = collections.deque()
            arrived = threading.Semaphore(0)
            threading.Thread(target=self.take, args=(source, queue, arrived), daemon=True).start()
            threading.Thread(target=self.give, args=(target, queue, arrived), daemon=True).start()
        return self

    def __exit__(self, *_):
        for side in SIDES:
            ip("netns", "del", side)

    def take(self, source, queue, arrived):
        while True:
            packet = os.read(source, 65536)
            queue.append((time.monotonic() + self.delay, packet))
            arrived.release()

    @staticmethod
    def give(target, queue, arrived):
        while True:
            arrived.acquire()
            due, packet = queue.popleft()
            rest = due - time.monotonic()
            if rest > 0:
                time.sleep(rest)
            os.write(target, packet)

    def round_trip(self):
        """Seconds that a small packet takes there and back: the median of 200."""
        echo = subprocess.Popen(
            ["ip", "netns", "exec", SIDES[1], sys.executable, "-c",
             "import socket\ns = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
             f"s.bind(('{ADDRESSES[1]}', 7))\nprint('up', flush=True)\n"
             "while True: s.sendto(*s.recvfrom(100))"], stdout=subprocess.PIPE)
        echo.stdout.readline()
        with open("/proc/self/ns/net", encoding="ascii") as home:
            enter(SIDES[0])
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as pinger:
                ctypes.CDLL(None).setns(home.fileno(), 0x40000000)
                pinger.connect((ADDRESSES[1], 7))
                times = []
                for _ in range(200):
                    start = time.monotonic()
                    pinger.send(b"x")
                    pinger.recv(100)
                    times.append(time.monotonic() - start)
        echo.kill()
        echo.wait()
        return sorted(times)[len(times) // 2]


def delay(program):
    print("| object | method | delay | round trip measured | thinning: trades + sums | time in them "
          "| added time | model |")
    print("|---|---|---|---|---|---|---|---|")
    with Link() as link, tempfile.TemporaryDirectory() as folder:
        agent = pathlib.Path(folder) / "agent"
        agent.write_text(AGENT, encoding="ascii")
        agent.chmod(0o755)
        launch = ["ip", "netns", "exec", SIDES[0], *MPIRUN, "--host", ",".join(ADDRESSES), "-n", "2",
                  "--map-by", "node", "--mca", "plm_rsh_agent", str(agent), "--mca", "btl",
                  "tcp,self", "--mca", "btl_tcp_if_include", "10.19.7.0/24", "--mca",
                  "oob_tcp_if_include", "10.19.7.0/24", "--mca", "pml", "ob1"]
        for name, options in JOBS.items():
            first = None
            for wanted in (0, 1e-4, 1e-3):
                link.delay = wanted
                trip = link.round_trip()
                seconds = math.inf
                for _ in range(5):
                    result, stages, _ = run([*launch, *job_words(program, "ball", 4_000_000, options)])
                    seconds = min(seconds, max(of.seconds for of in stages["thinning"]))
                meetings = stages["thinning"][0].trades + stages["thinning"][0].sums
                first = first or (seconds, trip)
                model = meetings * (trip - first[1]) / 2
                print(f"| ball 4M | {name} | {wanted * 1000:.1f} ms | {trip * 1000:.2f} ms | {meetings} "
                      f"| {seconds:.2f} s | {seconds - first[0]:.2f} s | {model:.2f} s |", flush=True)
                assert result["certificate"]


# ---- model

# Measured on one thread of the machine of client/mpi/README.md, by `counts` and by larger balls:
# ns of processor time a point; bytes a point on the wire where there are many ranks; bytes a shell for
# each cell of the lattice's edge and each side of a rank.
Method = collections.namedtuple("Method", "distances in_turn thinning trades bytes_a_point bytes_a_cell")
METHODS = {"symmetric": Method(35, 0, 15, 1, 11.5, 40), "directional": Method(0, 24, 8, 8, 0.3, 55)}
# Latency of a small message in seconds, bytes a second.
NETWORKS = {"25 Gbit": (25e-6, 0.9 * 25e9 / 8), "InfiniBand": (2e-6, 0.9 * 200e9 / 8)}
LOOKOUT = 50e-6     # the interval at which a waiting rank polls (client/mpi/mpi_exchange.cc)
THREADS = 16 * 0.8  # of a rank, and their efficiency
UNEVEN = 1.3        # what the busiest rank has of a shell, in shares
# Edge in cells, part of the lattice that is object, shells, and ns a point that rank 0 takes alone for
# cleaning up, pruning and the graph on one thread, by method.
BALL, TREE = {"symmetric": 0.1, "directional": 3}, {"symmetric": 13, "directional": 13}
OBJECTS = {"ball, 4096^3": (4096, 0.52, 4096, BALL), "tree, 4096^3": (4096, 0.0034, 200, TREE),
           "ball, 16384^3": (16384, 0.52, 16384, BALL), "tree, 16384^3": (16384, 0.0034, 800, TREE)}


def modeled(of, name, ranks, network):
    """Seconds of the parts of a job."""
    cells, fill, shells, alone = of
    method = METHODS[name]
    latency, bandwidth = network
    points = 2 * cells ** 3 * fill
    layers = cells / 8
    busy = min(ranks, layers)  # distances go by whole layers
    beside = 1 + 2 / max(layers / ranks, 1)
    ns = 1e-9 / THREADS
    sums = 2 * math.log2(ranks) * latency + LOOKOUT
    trades = latency + LOOKOUT + 2 * method.bytes_a_cell * cells / method.trades / bandwidth
    return {
        "computing": points * ns * beside * (method.distances / busy + method.thinning * UNEVEN / ranks),
        "one after the other": points * ns * method.in_turn,
        "synchronizing": shells * (method.trades * trades + sums),
        "sending": points * (method.bytes_a_point / busy + 72 / 512) / bandwidth,
        "rank 0 alone": points * alone[name] * 1e-9,
    }


def model():
    parts = list(modeled(OBJECTS["ball, 4096^3"], "symmetric", 16, NETWORKS["25 Gbit"]))
    print("| object | method | network | ranks | seconds | " + " | ".join(parts) + " |")
    print("|---" * (5 + len(parts)) + "|")
    for name, of in OBJECTS.items():
        for method in METHODS:
            for network in NETWORKS:
                for ranks in (16, 128, 1024):
                    times = modeled(of, method, ranks, NETWORKS[network]).values()
                    print(f"| {name} | {method} | {network} | {ranks} | {sum(times):,.0f} | "
                          + " | ".join(f"{each:,.1f}" for each in times) + " |")


def main():
    commands = {"counts": counts, "delay": delay, "model": model}
    if len(sys.argv) < 2 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]](*sys.argv[2:])


if __name__ == "__main__":
    main()
