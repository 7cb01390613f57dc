"""Plants violations and expects include_rules.py to find each of them."""

import unittest

from include_rules import Rules, check_file

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

    def test_finds_arrows_that_run_in_a_circle(self):
        self.assertEqual(len(list(Rules("a: b\nb: a\n").defects())), 2)


if __name__ == "__main__":
    unittest.main()
