"""Holds the .proto files to what was promised and to the style of `buf lint` STANDARD.

proto/interface.txt is the interface as it was last blessed, one fact per line. Whatever it names must
stay as it is: callers were built with it. After adding something:

    python3 tests/proto/interface_test.py --bless
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from google.protobuf import descriptor_pb2

PROTO = pathlib.Path(__file__).resolve().parents[2] / "proto"
BLESSED = PROTO / "interface.txt"
COMMAND = "python3 tests/proto/interface_test.py --bless"

PASCAL = re.compile(r"([A-Z][a-z0-9]+)+")
LOWER_SNAKE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
UPPER_SNAKE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")


def compile_protos(folder, *options):
    """The descriptors of a folder's .proto files, and what protoc complained about."""
    files = sorted(str(path.relative_to(folder)) for path in folder.glob("**/*.proto"))
    with tempfile.NamedTemporaryFile() as out:
        done = subprocess.run([os.environ.get("PROTOC", "protoc"), "-I", folder, *options,
                               f"--descriptor_set_out={out.name}", *files],
                              check=True, capture_output=True, text=True)
        return descriptor_pb2.FileDescriptorSet.FromString(out.read()), done.stderr


# What can be named: a dictionary from a path such as "field file.proto: package.Message.field" to its
# meaning.

def field_facts(message, field):
    kind = descriptor_pb2.FieldDescriptorProto
    words = [str(field.number), kind.Label.Name(field.label).removeprefix("LABEL_").lower(),
             kind.Type.Name(field.type).removeprefix("TYPE_").lower()]
    words += [field.type_name] if field.type_name else []
    if field.HasField("oneof_index"):
        words.append(f"oneof {message.oneof_decl[field.oneof_index].name}")
    return " ".join(words)


def message_facts(prefix, message):
    name = f"{prefix}{message.name}"
    yield f"message {name}", ""
    for field in message.field:
        yield f"field {name}.{field.name}", field_facts(message, field)
    for reserved in message.reserved_range:
        for number in range(reserved.start, reserved.end):
            yield f"reserved {name} {number}", ""
    for inner in message.nested_type:
        yield from message_facts(f"{name}.", inner)
    for enum in message.enum_type:
        yield from enum_facts(f"{name}.", enum)


def enum_facts(prefix, enum):
    yield f"enum {prefix}{enum.name}", ""
    for value in enum.value:
        yield f"value {prefix}{enum.name}.{value.name}", str(value.number)


def service_facts(prefix, service):
    yield f"service {prefix}{service.name}", ""
    for method in service.method:
        takes = "stream " * method.client_streaming + method.input_type
        returns = "stream " * method.server_streaming + method.output_type
        yield f"rpc {prefix}{service.name}.{method.name}", f"({takes}) returns ({returns})"


def facts(descriptors):
    found = {}
    for file in descriptors.file:
        prefix = f"{file.name}: {file.package}."
        for message in file.message_type:
            found.update(message_facts(prefix, message))
        for enum in file.enum_type:
            found.update(enum_facts(prefix, enum))
        for service in file.service:
            found.update(service_facts(prefix, service))
    return found


def breaks(blessed, now):
    """What callers relied on and is no longer so."""
    return sorted([f"removed: {name}" for name in blessed.keys() - now.keys()] +
                  [f"changed: {name}: {blessed[name]} -> {now[name]}" for name in blessed.keys() & now.keys()
                   if blessed[name] != now[name]])


def blessed_facts():
    lines = BLESSED.read_text().splitlines()[1:]
    return {name: meaning for name, _, meaning in (line.partition(" = ") for line in lines)}


def bless():
    descriptors, _ = compile_protos(PROTO)
    now = facts(descriptors)
    broken = breaks(blessed_facts(), now) if BLESSED.exists() else []
    if broken:
        sys.exit("not blessed, callers would break:\n  " + "\n  ".join(broken))
    BLESSED.write_text("# Made by " + COMMAND + "; see proto/README.md.\n" +
                       "".join(f"{name} = {meaning}\n" if meaning else f"{name}\n"
                               for name, meaning in sorted(now.items())))


class CompatibilityTest(unittest.TestCase):
    def test_what_was_blessed_is_still_there(self):
        self.assertEqual(breaks(blessed_facts(), facts(compile_protos(PROTO)[0])), [])

    def test_everything_is_blessed(self):
        new = facts(compile_protos(PROTO)[0]).keys() - blessed_facts().keys()
        self.assertEqual(sorted(new), [], f"to keep it from now on, run {COMMAND}")


BEFORE = """syntax = "proto3"; package t.v1;
message A { reserved 9; string one = 1; oneof either { int32 two = 2; int32 three = 3; } }
enum E { E_UNSPECIFIED = 0; E_ONE = 1; }
service S { rpc Do(A) returns (A); }"""


class BreakTest(unittest.TestCase):
    """The comparison sees what it is for."""

    def compare(self, *replacement):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "t.proto"
            path.write_text(BEFORE)
            before = facts(compile_protos(path.parent)[0])
            path.write_text(BEFORE.replace(*replacement))
            return breaks(before, facts(compile_protos(path.parent)[0]))

    def test_an_addition_breaks_nothing(self):
        self.assertEqual(self.compare("reserved 9;", "reserved 9; string four = 4;"), [])

    def test_every_kind_of_break_is_seen(self):
        for old, new in (("string one = 1;", ""), ("one = 1", "one = 4"),
                         ("string one", "bytes one"), ("string one", "repeated string one"),
                         ("string one", "optional string one"),
                         ("string one = 1; oneof either {", "oneof either { string one = 1;"),
                         ("reserved 9;", ""), ("E_ONE = 1;", ""), ("E_ONE = 1", "E_ONE = 2"),
                         ("rpc Do(A)", "rpc Do(stream A)"), ("rpc Do(A)", "rpc Make(A)"),
                         ("service S", "service T")):
            self.assertNotEqual(self.compare(old, new), [], f"{old} -> {new}")


class StyleTest(unittest.TestCase):
    """The rules of `buf lint` STANDARD, and a comment for every service and call."""

    @classmethod
    def setUpClass(cls):
        descriptors, cls.complaints = compile_protos(PROTO, "--include_source_info")
        cls.files = descriptors.file

    def expect(self, pattern, name):
        self.assertTrue(pattern.fullmatch(name), f"{name} is not {pattern.pattern}")

    def test_protoc_complains_about_nothing(self):
        self.assertEqual(self.complaints, "")  # unused imports among them

    def test_files_and_packages(self):
        for file in self.files:
            path = pathlib.PurePath(file.name)
            self.expect(LOWER_SNAKE, path.stem)
            self.assertEqual((file.syntax, file.package), ("proto3", ".".join(path.parts[:-1])))
            self.assertRegex(file.package, r"^[a-z][a-z0-9_.]*\.v[1-9][0-9]*$")
            self.assertFalse(list(file.public_dependency) + list(file.weak_dependency))

    def all_messages(self):
        waiting = [message for file in self.files for message in file.message_type]
        while waiting:
            message = waiting.pop()
            waiting += message.nested_type
            yield message

    def test_messages_and_fields(self):
        for message in self.all_messages():
            self.expect(PASCAL, message.name.removesuffix("Entry"))
            for named in (*message.field, *message.oneof_decl):
                self.expect(LOWER_SNAKE, named.name.removeprefix("_"))

    def test_enums(self):
        enums = [e for file in self.files for e in file.enum_type]
        for enum in enums + [e for m in self.all_messages() for e in m.enum_type]:
            self.expect(PASCAL, enum.name)
            self.assertFalse(enum.options.allow_alias)
            prefix = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", enum.name).upper() + "_"
            self.assertEqual((enum.value[0].name, enum.value[0].number), (f"{prefix}UNSPECIFIED", 0))
            for value in enum.value:
                self.expect(UPPER_SNAKE, value.name)
                self.assertTrue(value.name.startswith(prefix), value.name)

    def test_services_and_calls(self):
        used = []
        for file in self.files:
            for service in file.service:
                self.expect(PASCAL, service.name)
                self.assertTrue(service.name.endswith("Service"))
                for method in service.method:
                    self.expect(PASCAL, method.name)
                    types = [method.input_type.split(".")[-1], method.output_type.split(".")[-1]]
                    self.assertEqual(types, [f"{method.name}Request", f"{method.name}Response"])
                    used += types
        self.assertEqual(len(used), len(set(used)), "calls share a message")

    def test_services_and_calls_have_comments(self):
        for file in self.files:
            commented = {tuple(place.path) for place in file.source_code_info.location
                         if place.leading_comments.strip()}
            for s, service in enumerate(file.service):
                self.assertIn((6, s), commented, service.name)
                for m, method in enumerate(service.method):
                    self.assertIn((6, s, 2, m), commented, f"{service.name}.{method.name}")


if __name__ == "__main__":
    if sys.argv[1:] == ["--bless"]:
        bless()
    else:
        unittest.main()
