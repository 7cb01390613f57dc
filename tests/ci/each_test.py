""".ci/each: every command is run, and none that fails is passed over."""

import pathlib
import subprocess
import unittest

EACH = pathlib.Path(__file__).resolve().parents[2] / ".ci/each"


def each(*commands):
    """The exit code, and the lines that say what became of the commands."""
    ended = subprocess.run([EACH], input="\n".join(commands), capture_output=True, text=True,
                           timeout=60, check=False)
    return ended.returncode, [line.split()[0] for line in ended.stdout.splitlines()
                              if line.startswith(("ok", "skipped", "FAILED"))]


class EachTest(unittest.TestCase):
    def test_one_that_fails_stops_none_of_the_others_but_fails_all(self):
        self.assertEqual(each("true", "false", "true"), (1, ["ok", "FAILED", "ok"]))

    def test_77_is_skipped(self):
        self.assertEqual(each("exit 77", "true"), (0, ["skipped", "ok"]))
        self.assertEqual(each("exit 77", "exit 1"), (1, ["skipped", "FAILED"]))

    def test_a_command_ends_at_its_first_failure(self):
        self.assertEqual(each("false; true"), (1, ["FAILED"]))
        self.assertEqual(each("false | true"), (1, ["FAILED"]))

    def test_a_command_does_not_read_the_commands_after_it(self):
        self.assertEqual(each("cat >/dev/null", "true"), (0, ["ok", "ok"]))

    def test_remarks_are_passed_over_and_no_commands_are_a_mistake(self):
        self.assertEqual(each("# a remark", "", "true"), (0, ["ok"]))
        self.assertEqual(each("# a remark"), (2, []))


if __name__ == "__main__":
    unittest.main()
