#!/usr/bin/env python3
"""What scripts/bench_table.py makes of the benchmarks' output: no row may be lost in silence."""

import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
from bench_table import closest_point_table, hierarchy_table, some  # noqa: E402

CLOSEST = """5041 triangles: build 0.001 s, CGAL 0.002 s; 90 bytes per triangle
  queries per second         adamas       CGAL    ratio
  near the surface          4000000    1000000     4.00   (3.90 to 4.10; 0 differ)
  anywhere in the box        800000     400000     2.00   (1.90 to 2.10; {} differ)
"""


class BenchTableTest(unittest.TestCase):
    def test_rows(self):
        rows = list(closest_point_table(CLOSEST.format(0)))
        self.assertEqual([r[0] for r in rows], ["closest points, near the surface", "closest points, anywhere in the box"])
        self.assertEqual(rows[0][1:4], ["4.00 M/s", "CGAL AABB 1.00 M/s", "4.00"])
        runs = {"benchmarks": [{"name": "splits/random/1000", "splits": 2e6, "bytes_per_tetrahedron": 100}]}
        self.assertEqual([r[3] for r in hierarchy_table("bench_hierarchy", runs)], ["2.00", "0.50"])

    def test_differences_fail(self):
        with self.assertRaisesRegex(SystemExit, "found 3 that differ"):
            list(closest_point_table(CLOSEST.format(3)))

    def test_other_output_fails(self):
        with self.assertRaisesRegex(SystemExit, "expected rows, found none"):
            some("closest points", closest_point_table("nothing\n"))
        with self.assertRaisesRegex(SystemExit, "found other"):
            list(hierarchy_table("bench_hierarchy", {"benchmarks": [{"name": "other"}]}))


if __name__ == "__main__":
    unittest.main()
