"""Fails where an include points backward along the path of a volume, where two headers define a class
of the same name (the linker then takes either one's destructor for both), and where a call does not
compile with the fuzzers' compiler.

Usage: include_rules.py ROOT ARROWS
Reads every C++ file under core, proto, server and client of ROOT; prints one line per violation.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')
NAMESPACE = re.compile(r"^namespace ([\w:]*) ?{$")
CLASS = re.compile(r"^(?:class|struct) (?:alignas\(\w+\) )?(\w+)[^;]*$")
# With the standard library of GCC 12, clang 14 compiles neither std::ranges::subrange, which these
# algorithms return, nor views. It also warns of signs where an unsigned variable goes through a
# list of ints, such as {1, 2}; {1u, 2u} is right.
NOT_FOR_CLANG = re.compile(
    r"\b(?:std::views::\w+|std::ranges::(?:views::\w+|(?:unique|remove|remove_if|rotate|partition"
    r"|stable_partition|search|search_n|find_end|find_last|equal_range)\b)"
    r"|(?:size_t|uint\d+_t) \w+ : \{-?\d+[,}])")
SUFFIXES = {".h", ".cc"}
TOP_FOLDERS = ("core", "proto", "server", "client")
MAX_LINES = 400


class Rules:
    """The arrows between our folders, and where headers of others may be included."""

    def __init__(self, text):
        self.arrows = {}
        self.only = {}
        for line in text.splitlines():
            line = line.split("#")[0].strip()
            if not line:
                continue
            name, _, targets = line.partition(":")
            if name.startswith("!"):
                self.only[name[1:].strip()] = targets.split()
            else:
                self.arrows[name.strip()] = targets.split()

    def reach(self, folder):
        """All folders that `folder` may include."""
        seen, todo = set(), [folder]
        while todo:
            here = todo.pop()
            if here not in seen:
                seen.add(here)
                todo += self.arrows.get(here, [])
        return seen

    def owner(self, path):
        """The longest folder of the arrows that holds `path`, or None."""
        best = None
        for folder in self.arrows:
            if path.startswith(folder + "/") and (best is None or len(folder) > len(best)):
                best = folder
        return best

    def defects(self):
        for folder, targets in self.arrows.items():
            for target in targets:
                if target not in self.arrows:
                    yield f"arrows: {folder} points at {target}, which has no line"
                elif folder in self.reach(target):
                    yield f"arrows: {folder} and {target} point at each other"


def includes(text):
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def violation(rules, owner, header):
    """Why a file of `owner` may not include `header`, or None."""
    if header.startswith(tuple(top + "/" for top in TOP_FOLDERS)):
        target = rules.owner(header)
        if target is None:
            return f"{header} is in a folder without a line in the arrows"
        if target not in rules.reach(owner):
            return f"{owner} -> {target} is not an arrow"
        return None
    for prefix, folders in rules.only.items():
        named = header == prefix or header.startswith((prefix + "/", prefix + "."))
        if named and not any((owner + "/").startswith(folder + "/") for folder in folders):
            return f"{prefix} belongs to {', '.join(folders)} only"
    return None


def check_file(rules, path, text):
    """Yields `path:line: reason` for one file; `path` is relative to the root."""
    owner = rules.owner(path)
    if owner is None:
        yield f"{path}:1: its folder has no line in the arrows"
        return
    lines = text.count("\n")
    if lines > MAX_LINES:
        yield f"{path}:{lines}: longer than {MAX_LINES} lines"
    for number, header in includes(text):
        reason = violation(rules, owner, header)
        if reason:
            yield f"{path}:{number}: includes {header}: {reason}"


def refused_by_clang(path, text):
    """Yields `path:line: reason` for what only the fuzzers and the nightly checks would find."""
    for number, line in enumerate(text.splitlines(), 1):
        if match := NOT_FOR_CLANG.search(line.split("//")[0]):
            yield f"{path}:{number}: {match.group()} does not compile with clang 14"


def classes(text):
    """Yields the line and the full name of each class that is defined at namespace scope."""
    namespaces = []
    for number, line in enumerate(text.splitlines(), 1):
        if match := NAMESPACE.match(line):
            namespaces.append(match.group(1))
        elif line.startswith("}  // namespace"):
            namespaces.pop()
        elif match := CLASS.match(line):
            yield number, "::".join([*namespaces, match.group(1)])


def defined_twice(files):
    """Yields `path:line: reason` for each class of a header that an earlier header defines, too."""
    first = {}
    for path, text in files:
        if not path.endswith(".h"):
            continue
        for number, name in classes(text):
            if first.setdefault(name, path) != path:
                yield f"{path}:{number}: {first[name]} defines {name}, too"


def sources(root, folders):
    for top in folders:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SUFFIXES:
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def main(root, arrows):
    rules = Rules(pathlib.Path(arrows).read_text(encoding="utf-8"))
    found = list(rules.defects())
    files = list(sources(pathlib.Path(root), TOP_FOLDERS))
    for path, text in files:
        found += check_file(rules, path, text)
    for path, text in files + list(sources(pathlib.Path(root), ("tests",))):
        found += refused_by_clang(path, text)
    found += defined_twice(files)
    if not files:
        found.append(f"{root}: no C++ file found")
    for line in found:
        print(line)
    print(f"{len(files)} files read, {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
