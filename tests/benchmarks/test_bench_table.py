#!/usr/bin/env python3
"""What scripts/bench_table.py makes of the benchmarks' output: no row may be lost in silence."""

import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
from bench_large import QUICK, ball_centres, check_samples, distance_from_spheres, write_sparse  # noqa: E402
from bench_series import coefficient_table, file_rows, needs_row, play_plots, reading_row, Series, time_row, whole  # noqa: E402
from bench_table import closest_point_table, hierarchy_table, some  # noqa: E402
from bench_volumes import codec_table, contour_table, quality_table, surface_table  # noqa: E402

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

    def test_lossless_coders(self):
        coders = {"interpolation": 100, "split edge": 200, "JPEG-LS": 150, "Lorenzo + zstd -19": 250}
        lines = [{"volume": name, "type": "uint8", "dimensions": [10, 10, 10], "coder": coder, "input": 1000,
                  "bytes": factor * size, "decode": 6e8, "restore": 1.5e8}
                 for name, factor in (("a", 1), ("b", 4)) for coder, size in coders.items()]
        rows = {r[0] + r[2][:7]: r for r in codec_table(lines)}
        self.assertEqual(rows["lossless, a: interpolationJPEG-LS"][1:4:2], ["10.00 at 600 M/s", "1.50"])
        # This is the geometric mean of 10 and 2.5, beside that of 6.67 and 1.67.
        self.assertEqual(rows["lossless, geometric mean: interpolationJPEG-LS"][1:4], ["5.00", "JPEG-LS 3.33", "1.50"])
        self.assertEqual(rows["decode, interpolation, pages to values300 M/s"][3], "0.50")

    def test_contours_must_be_equal(self):
        line = {"mesh": "fine", "tetrahedra": 10, "triangles": 4, "peer_triangles": 4, "shared": True, "normals": False,
                "adamas": 3e6, "peer": 2e6, "ratio": 1.5}
        self.assertEqual([r[3:5] for r in contour_table([line])], [["1.50", ">= 1.5"]])
        with self.assertRaisesRegex(SystemExit, "expected 5 triangles, found 4"):
            list(contour_table([line | {"peer_triangles": 5}]))

    def test_surfaces_of_measured_volumes(self):
        def line(surface, distance):
            return {"surface": surface, "triangles": 100, "seconds": 1, "to": [distance] * 3, "from": [3 * distance] * 3,
                    "angle": 30, "narrow": 0.1}
        lines = [line("adamas, error 0", 0), line("adamas, error 0, plain", 0), line("Flying Edges, stride 2", 2),
                 line("adamas", 1), line("adamas, plain", 4), line("vtkDecimatePro", 2)]
        ratios = {}
        rows = list(quality_table("head", lines, ratios))
        self.assertEqual([r[3] for r in rows], ["1.00", "0.50", "0.50", "0.50", "0.25", "0.50"])
        self.assertEqual(rows[1][1:3], ["2.000", "Flying Edges 4.000"])
        self.assertEqual(rows[2][1], "3.000")
        self.assertEqual(ratios, {"mean distance": [0.5], "99.9% within": [0.5]})
        with self.assertRaisesRegex(SystemExit, "expected one of adamas, found vtkDecimatePro"):
            list(quality_table("head", lines[:3] + lines[5:], ratios))

    def test_surfaces_from_disk(self):
        ours = {"seconds": 1, "processor_seconds": 2, "peak_bytes": 2**20, "triangles": 10}
        peer = {"seconds": 4, "processor_seconds": 4, "peak_bytes": 2**22, "triangles": 40}
        line = {"row": "time", "wanted": "10 triangles", "cold": True, "normals": True, "adamas": ours, "peer": peer,
                "error": 0.5}
        rows = list(surface_table([line]))
        self.assertEqual([r[3:5] for r in rows], [["0.25 (0.50)", "<= 0.25"], ["0.25", "<= 0.1"]])
        with self.assertRaises(KeyError):
            list(surface_table([{"row": "other"}]))

    def test_spheres_of_the_large_volume(self):
        # The surfaces are octahedra whose corners are a little beyond spheres of radius 23.45.
        steps = [[s * (a == axis) for a in range(3)] for axis in range(3) for s in (-23.55, 23.55)]
        centres = ((0, 0, 0), (100, 200, 300))
        vertices = [[c + s for c, s in zip(centre, step)] for centre in centres for step in steps]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mesh.obj")
            for faces in (16, 15):
                with open(path, "w", encoding="utf-8") as file:
                    file.writelines("v {} {} {}\n".format(*v) for v in vertices)
                    file.writelines(["f 1 2 3\n"] * faces)
                if faces == 16:
                    self.assertAlmostEqual(distance_from_spheres(path, centres), 0.1)
                else:
                    with self.assertRaisesRegex(SystemExit, "expected 2 closed spheres"):
                        distance_from_spheres(path, centres)

    def test_samples_of_the_large_volume(self):
        with tempfile.TemporaryDirectory() as folder:
            raw, part = os.path.join(folder, "large.raw"), os.path.join(folder, "part.raw")
            write_sparse(raw, QUICK)
            x, y, z = ball_centres(QUICK)[1]
            box = [(x, x + 1), (y, y), (z, z)]
            for found in (bytes([255, 245]), bytes([255, 244]), bytes([255, 245, 0])):
                with open(part, "wb") as file:
                    file.write(found)
                if found == bytes([255, 245]):
                    check_samples(QUICK, raw, part, box)
                else:
                    with self.assertRaisesRegex(SystemExit, "expected the samples"):
                        check_samples(QUICK, raw, part, box)

    def test_series(self):
        def played(reads, size):
            frames = [{"step": n, "page_faults": reads, "bytes_read": size, "seconds": 0.5, "triangles": 7} for n in range(2)]
            return {"frames": frames, "page_faults": 2 * reads, "bytes_read": 2 * size, "part_read": 0.25, "triangles_mean": 3e5, "processor_seconds": 4}
        coded, plain = ({"bytes_file": n, "bytes_data": n // 2, "bytes_errors": n // 4, "bytes_input": 8000, "type": "uint16"} for n in (4000, 16000))
        part = {"input": 8000, "alone": 9000, "in_turn": 8000, "interleaved": 7000, "least": 5000}
        # A page has five bytes of errors and ranges for two of samples.
        zstd = {"samples": part, "errors and ranges": part | {"input": 20000, "least": 3000}}
        self.assertEqual([r[3] for r in file_rows("a", coded, plain, zstd)], ["0.250", "0.500", "0.400", "0.333"])
        self.assertEqual(whole(part, 16000)["least"], 10000)
        series = Series("a", 1, [], aim=0.3)
        row = reading_row(series, 10, 2, played(3, 1000), played(4, 4000))
        self.assertEqual(row[1:5], ["6 reads, 2 kB (25.0%)", "uncompressed 8 reads, 8 kB (25.0%)", "0.250", "<= 30% of the file"])
        # The sizes are a quarter more and a quarter less than ten steps of 4096 samples of two bytes.
        self.assertIn("61,440 to 102,400 as read", row[5])
        contoured = [{"step": n, "triangles": 5, "processor_seconds": 0.5} for n in range(2)]
        self.assertEqual(time_row(series, [played(1, 1)] * 3, [contoured] * 3)[1:5], ["2000.0 ms", "raw + Flying Edges 500.0 ms", "4.00", "<= 0.5"])
        plots = play_plots({10: (played(3, 1000), played(4, 4000))}, lambda frames: [f["page_faults"] for f in frames], "reads")
        self.assertEqual([line["y"] for line in plots[0]["series"]], [[3, 3], [4, 4]])
        few = played(3, 1000)
        few["frames"][0]["triangles"] = 1
        self.assertEqual(play_plots({10: (few, few)}, lambda frames: [1 for f in frames], "1", part=0.5)[0]["series"][0]["x"], [1])
        need = {which: {"pages": 2, "samples": size, "bounds": 1000} for which, size in
                (("not needed", 1000), ("in time", 2000), ("in space", 3000), ("crossed", 4000))}
        self.assertIn("2 pages and steps that the surface of all samples crosses 5 kB", needs_row("a", played(1, 1), need | {"others": 7})[5])

    def test_coefficients(self):
        found = {"samples": {"0": 1, "200": 3}, "differences": {"0": 2, "1": 1, "300": 1}, "residuals": {"0": 3, "5": 1}}
        rows = list(coefficient_table("a", found))
        self.assertEqual([r[1] for r in rows], ["50.0%", "75.0%"])
        self.assertEqual([r[2] for r in rows], ["samples 25.0%"] * 2)
        self.assertIn("at most 1: 75.0%; greatest 300", rows[0][5])


if __name__ == "__main__":
    unittest.main()
