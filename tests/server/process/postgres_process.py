"""Debian's PostgreSQL as a process in a folder of its own, on a Unix socket, for the tests beside this."""

import os
import pathlib
import shutil
import subprocess
import tempfile


def programs():
    """The folder of the newest version's programs; None where there is none."""
    found = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    return found[-1].parent if found else None


class PostgresProcess:
    """Runs as nobody where the tests are root's, which it refuses to be."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bccskel-postgres-", dir="/tmp"))
        self.user = []
        if os.geteuid() == 0:
            self.user = ["runuser", "-u", "nobody", "--"]
            shutil.chown(self.folder, "nobody")
        self.run("initdb", "-D", self.folder / "data", "-A", "trust", "-U", "test", "-E", "UTF8",
                 "--no-sync")
        self.control("start")
        self.url = self.make("jobs")

    def make(self, database):
        """The URL of an empty database of this name, in place of the one before, if any."""
        server = ("-h", self.folder, "-U", "test", database)
        self.run("dropdb", "--if-exists", "--force", *server)
        self.run("createdb", *server)
        return f"postgresql://test@/{database}?host={self.folder}"

    def run(self, program, *arguments):
        with open(f"{self.folder}.log", "w", encoding="utf-8") as log:  # pg_ctl's child keeps it
            subprocess.run([*self.user, programs() / program, *map(str, arguments)], check=True,
                           stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd="/")

    def control(self, *what):
        self.run("pg_ctl", "-w", "-D", self.folder / "data", "-l", self.folder / "log",
                 "-o", f"-k {self.folder} -c listen_addresses='' -c fsync=off", *what)

    def stop(self):
        self.control("stop", "-m", "immediate")

    def start(self):
        self.control("start")

    def ask(self, sql):
        return subprocess.run([programs() / "psql", "-h", self.folder, "-U", "test", "-At", "jobs",
                               "-c", sql], check=True, capture_output=True, text=True).stdout.strip()

    def close(self):
        try:
            self.stop()
        except subprocess.CalledProcessError:
            pass  # it was stopped
        shutil.rmtree(self.folder)
        os.remove(f"{self.folder}.log")
