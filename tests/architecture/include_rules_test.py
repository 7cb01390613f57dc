"""Plants violations and expects include_rules.py to find each of them."""

import unittest

from include_rules import Rules, check_file, defined_twice, refused_by_clang

ARROWS = """
core/lattice:
core/volume: core/lattice   # with a comment
core/thinning: core/volume
core/io: core/volume
client: core/io
!grpc: client
!grpcpp: client
"""


def found(path, *headers):
    text = "".join(f'#include "{header}"\n' for header in headers)
    return list(check_file(Rules(ARROWS), path, text))


class IncludeRules(unittest.TestCase):
    def test_allows_what_an_arrow_reaches(self):
        self.assertEqual(found("core/thinning/a.cc", "core/volume/v.h", "core/lattice/l.h"), [])

    def test_allows_a_folder_to_include_itself(self):
        self.assertEqual(found("core/lattice/a.cc", "core/lattice/l.h"), [])

    def test_finds_a_backward_arrow(self):
        self.assertIn("core/volume -> core/thinning", found("core/volume/a.cc", "core/thinning/t.h")[0])

    def test_finds_a_sideward_arrow(self):
        self.assertEqual(len(found("core/thinning/a.h", "core/io/i.h")), 1)

    def test_finds_grpc_in_the_core(self):
        self.assertIn("grpcpp belongs to client only", found("core/io/a.cc", "grpcpp/x.h")[0])

    def test_allows_grpc_where_it_belongs(self):
        self.assertEqual(found("client/deep/a.cc", "grpc/y.h"), [])

    def test_finds_a_folder_without_a_line(self):
        self.assertEqual(len(found("core/surprise/a.cc")), 1)
        self.assertEqual(len(found("core/volume/a.cc", "core/surprise/s.h")), 1)

    def test_finds_a_file_over_the_ceiling(self):
        text = "\n" * 401
        self.assertEqual(len(list(check_file(Rules(ARROWS), "core/io/a.cc", text))), 1)

    def test_finds_what_the_fuzzers_compiler_refuses(self):
        def check(line):
            return list(refused_by_clang("core/io/a.cc", line + "\n"))

        self.assertEqual(check("  std::ranges::rotate(a, a.begin() + 1);"),
                         ["core/io/a.cc:1: std::ranges::rotate does not compile with clang 14"])
        self.assertEqual(len(check("for (int n : std::views::iota(0, 3)) {}")), 1)
        self.assertEqual(check("std::ranges::sort(a);  // not std::ranges::unique"), [])
        self.assertEqual(check("std::ranges::remove_copy(a, b, 0);"), [])
        self.assertEqual(check("for (const size_t n : {29, 31}) {"),
                         ["core/io/a.cc:1: size_t n : {29, does not compile with clang 14"])
        self.assertEqual(check("for (const size_t n : {29u, 31u}) {"), [])

    def test_finds_arrows_that_run_in_a_circle(self):
        self.assertEqual(len(list(Rules("a: b\nb: a\n").defects())), 2)

    def test_finds_a_class_that_two_headers_define(self):
        one = "namespace a {\nclass B final : public C {\n};\n}  // namespace a\n"
        other = "namespace a {\nstruct B {\n};\n}  // namespace a\n"
        self.assertEqual(list(defined_twice([("x.h", one), ("y.h", other)])),
                         ["y.h:2: x.h defines a::B, too"])

    def test_allows_equal_names_in_other_namespaces_and_declarations(self):
        one = "namespace a {\nclass B {\n};\n}  // namespace a\n"
        other = "namespace a {\nclass B;\n}  // namespace a\nnamespace c {\nclass B {\n};\n}\n"
        self.assertEqual(list(defined_twice([("x.h", one), ("y.h", other)])), [])


if __name__ == "__main__":
    unittest.main()
