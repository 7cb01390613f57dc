"""Help, man page, completions and README say the same as the program does."""

import json
import pathlib
import re
import shutil
import subprocess
import unittest

import harness

CLI = harness.SOURCES / "client/cli"
PAGE = pathlib.Path(harness.CLIENT).parent / "bccskel.1"
SERVER_PAGE = harness.SOURCES / "server/bccskel-server.1"
COMMANDS = ("voxelize", "submit", "skeletonize", "labels", "info", "view", "render", "convert", "reconstruct",
            "generate", "jobs", "watch", "cancel", "fetch", "delete", "bench core",
            "bench server", "probe", "top")


def options_of(command):
    """The options that --help lists, by their long names."""
    text = harness.bccskel(*command.split(), "--help").stdout
    return set(re.findall(r"^\s+(?:-\w,)?(--[a-z-]+)", text, re.M))


def reasons_in(path):
    """What looks like a reason in the code: nothing else there is in capitals and quotes."""
    code = re.sub(r"//.*", "", path.read_text())
    return set(re.findall(r'"([A-Z]+(?:_[A-Z]+)*)"', code))


class DocumentsTest(harness.TestCase):
    def test_the_man_page_has_a_section_per_command_with_every_option(self):
        page = PAGE.read_text().replace("\\-", "-")
        sections = dict(re.findall(r"^\.SS bccskel ([a-z ]+)\b.*?\n(.*?)(?=^\.S[SH])", page,
                                   re.M | re.S))
        sections = {name.strip(): text for name, text in sections.items()}
        self.assertEqual(set(sections), set(COMMANDS))
        for command in COMMANDS:
            for option in options_of(command) - {"--help"}:
                with self.subTest(command=command, option=option):
                    self.assertRegex(sections[command], rf"{option}\b")
        known = set().union(*map(options_of, COMMANDS))
        self.assertLessEqual(set(re.findall(r"--[a-z][a-z-]+", page)), known | {"--version", "--labels"})

    def test_the_man_page_describes_formats_and_exit_codes(self):
        page = PAGE.read_text()
        formats = page[page.index(".SH FORMATS"):]
        help_text = harness.bccskel("skeletonize", "--help").stdout
        for word in re.findall(r"\.(?:swc|vtp|graphml|obj|mrk\.json|json|csv|glb|exr|bccb|svg|png|html)\b", help_text):
            self.assertIn(word, formats)
        for code in re.findall(r"\b(\d+) [a-z]", help_text[help_text.index("Exit codes"):]):
            self.assertRegex(page, rf"\.B {code}\n")

    def test_the_servers_man_page_has_its_options_and_no_others(self):
        page = SERVER_PAGE.read_text().replace("\\-", "-")
        done = subprocess.run([harness.SERVER, "--help"], capture_output=True, text=True,
                              timeout=60, check=True)
        options = set(re.findall(r"^\s+(?:-\w,)?(--[a-z-]+)", done.stdout, re.M))
        self.assertEqual(set(re.findall(r"--[a-z][a-z-]+", page)), options)

    @unittest.skipIf(shutil.which("groff") is None, "groff is not installed")
    def test_groff_formats_the_man_pages_without_a_warning(self):
        for page in (PAGE, SERVER_PAGE):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", page],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""), page)

    def test_bash_completes_commands_options_and_values(self):
        def complete(*words):
            script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
                      '_bccskel "$1" "${@: -1}"; printf "%s\\n" "${COMPREPLY[@]}"')
            done = subprocess.run(["bash", "-c", script, "bash", CLI / "completions/bccskel",
                                   harness.CLIENT, *words], capture_output=True, text=True,
                                  timeout=300)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            return set(done.stdout.split())

        self.assertEqual(complete("s"), {"submit", "skeletonize"})
        self.assertEqual(complete("skeletonize", "--stu"), {"--stubble"})
        self.assertEqual(complete("skeletonize", "--stubble", ""), {"keep-two", "literal", "none"})
        self.assertEqual(complete("generate", "h"), {"horse", "hollow-ball"})
        self.assertEqual(complete("bench", "s"), {"server"})
        self.assertEqual(complete("skeletonize", "--points", ""), set())
        self.assertEqual(complete("skeletonize", "--output", self.path("")), {self.path("")})
        for command in COMMANDS:
            self.assertEqual(complete(*command.split(), "--"), options_of(command))

    def test_the_readme_names_every_key_of_the_summaries(self):
        readme = (harness.SOURCES / "client/README.md").read_text()
        self.tetrahedron("a.off")
        grid = ("--points", 9999)
        commands = [("voxelize", self.path("a.off"), *grid, "-o", self.path("a.exr")),
                    ("skeletonize", self.path("a.off"), *grid, "--local", "-o", self.path("a.swc")),
                    ("info", self.path("a.off")), ("info", self.path("a.exr")),
                    ("generate", "ball", "-o", self.path("b.exr")),
                    ("skeletonize", self.path("b.exr"), "--local", "-o", self.path("b.json")),
                    ("view", self.path("b.json"), "--object", self.path("b.exr"),
                     "-o", self.path("b.html")),
                    ("render", self.path("b.json"), "--object", self.path("b.exr"),
                     "-o", self.path("b.png")),
                    ("reconstruct", self.path("b.json"), "--object", self.path("b.exr"),
                     "-o", self.path("c.exr"))]
        for command in commands:
            for key in self.keys(json.loads(self.succeed(*command, "--json"))):
                with self.subTest(command=command[0], key=key):
                    self.assertIn(f"`{key}`", readme)

    def keys(self, value):
        if isinstance(value, dict):
            return set(value) | {k for inner in value.values() for k in self.keys(inner)}
        if isinstance(value, list):
            return {k for inner in value for k in self.keys(inner)}
        return set()

    def test_the_page_of_errors_has_every_reason_and_no_others(self):
        given = reasons_in(harness.SOURCES / "server/errors/call_error.h")
        for path in (harness.SOURCES / "proto/wire").glob("*.cc"):
            given |= reasons_in(path)
        table = (harness.SOURCES / "server/ERRORS.md").read_text()
        told = {reason for row in re.findall(r"(?m)^\|[^|]*\|([^|]*)\|", table)
                for reason in re.findall(r"`([A-Z_]{4,})`", row)}
        self.assertGreater(len(given), 20)
        self.assertEqual(told, given)

    def test_the_readme_names_every_exit_code(self):
        readme = (harness.SOURCES / "client/README.md").read_text()
        help_text = harness.bccskel("--help").stdout
        for code in re.findall(r"\b(\d+) [a-z]", help_text[help_text.index("Exit codes"):]):
            self.assertRegex(readme, rf"(?m)^\| {code} \|")


if __name__ == "__main__":
    harness.main()
