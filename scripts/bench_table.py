#!/usr/bin/env python3
"""Runs the benchmarks of a build folder and prints one table: bench_table.py BUILD [--quick] [--large] [PART ...]."""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time

from bench_frames import frame_rows
from bench_large import large_rows
from bench_scale import scale_rows
from bench_series import series_rows
from bench_volumes import volume_rows


def note(text):
    print(text, file=sys.stderr, flush=True)


def output_of(*command):
    note("bench: " + " ".join(os.path.basename(command[0]) if i == 0 else a for i, a in enumerate(command)))
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode not in (0, 3):  # 3: an error that was wanted was not reached
        sys.exit(f"bench: {command[0]} ended with {result.returncode}")
    return result.stdout


def some(what, rows):
    """The rows as a list. None at all means that a program prints something else than is looked for."""
    rows = list(rows)
    if not rows:
        sys.exit(f"bench: {what}: expected rows, found none")
    return rows


def millions(rate):
    return f"{rate / 1e6:.2f} M/s"


# By program: name, splits or merges per second wanted, what memory is counted for, and bytes of it wanted.
HIERARCHIES = {"bench_hierarchy": ("hierarchy", 1e6, "tetrahedron", 200),
               "bench_indexed_hierarchy": ("indexed hierarchy", 2e6, "diamond", 48)}


def hierarchy_table(program, found):
    """Rows of Google Benchmark's JSON."""
    title, rate_wanted, element, bytes_wanted = HIERARCHIES[program]
    for run in found["benchmarks"]:
        name = re.fullmatch(r"(\w+)/(\w+)/(\d+)", run["name"])
        if name is None:
            sys.exit(f"bench: expected a benchmark named kind/order/size, found {run['name']}")
        kind, order, leaves = name.groups()
        rate = run[kind]
        at = f"{int(leaves):,} tetrahedra, {order} requests, 1 thread"
        yield [f"{title}: {kind}", millions(rate), f"{rate_wanted / 1e6:.0f} M/s (aim)", f"{rate / rate_wanted:.2f}",
               ">= 1", at]
        if kind == "splits":
            size = run[f"bytes_per_{element}"]
            yield [f"{title}: bytes per {element}", f"{size:.0f}", f"{bytes_wanted} (aim)", f"{size / bytes_wanted:.2f}",
                   "<= 1", at]


def hierarchy_rows(build, quick):
    least = f"--benchmark_min_time={0.5 if quick else 2}"
    for program in HIERARCHIES:
        path = os.path.join(build, "tests/benchmarks", program)
        yield from hierarchy_table(program, json.loads(output_of(path, "--benchmark_format=json", least)))


def closest_point_table(text):
    """Rows of what bench_closest_point prints."""
    triangles = ""
    for line in text.splitlines():
        size = re.match(r"(\d+) triangles", line)
        if size:
            triangles = f"{int(size.group(1)):,} triangles"
        rates = re.match(r"\s+(near the surface|anywhere in the box)\s+(\d+)\s+(\d+)\s+([\d.]+)\s+\(.*; (\d+) differ\)", line)
        if rates is None:
            continue
        where, ours, cgal, ratio, differ = rates.groups()
        if int(differ) > 0:
            sys.exit(f"bench: closest points, {where}: expected the distances of CGAL, found {differ} that differ")
        aim = ">= 3" if where == "near the surface" else ""
        yield [f"closest points, {where}", millions(float(ours)), f"CGAL AABB {millions(float(cgal))}", ratio, aim,
               f"{triangles}, the same points, 1 thread"]


def closest_point_rows(build, quick):
    program = os.path.join(build, "tests/benchmarks/bench_closest_point")
    yield from closest_point_table(output_of(program, *(["--quick"] if quick else [])))


def selection_rows(build, quick):
    program = os.path.join(build, "tests/benchmarks/bench_selection")
    found = json.loads(output_of(program, *(["--quick"] if quick else [])))
    rate = found["changed_per_second"]
    yield ["selection: tetrahedra changed", millions(rate), "1 M/s (aim)", f"{rate / 1e6:.2f}", ">= 1",
           f"tree of {found['tetrahedra']:,} tetrahedra, to 16 times the error and back, cells listed, 1 thread"]


def resample(adamas, folder, data, *options):
    figures = os.path.join(folder, "figures.json")
    output_of(adamas, "resample", data, *options, "--quiet", "--json", figures, "-o", os.path.join(folder, "mesh.vtu"))
    with open(figures, encoding="utf-8") as file:
        return json.load(file)


def growth_text(figures, last, cells):
    """Exponent of the time against the number of cells, from one size to the next."""
    if last is None:
        return ""
    return f"time ~ cells^{math.log(figures['seconds'] / last['seconds']) / math.log(cells):.2f}"


def resample_row(name, figures, growth, target, aim=""):
    ours = f"{figures['seconds']:.2f} s, {figures['peak_memory_bytes'] / 2**20:.0f} MiB"
    reached = figures.get("interface_error")
    at = f"{figures['tetrahedra']:,} tetrahedra, interface error "
    at += f"{reached:.3g} (wanted {target})" if reached is not None else f"wanted {target}"
    return [f"resample {name}", ours, "", growth, aim, at]


def sphere_rows(build, quick):
    adamas = os.path.join(build, "cli/adamas")
    last = None
    for n in (32, 64, 128) if quick else (64, 128, 256):
        with tempfile.TemporaryDirectory() as folder:
            data = os.path.join(folder, "sphere.vti")
            output_of(adamas, "generate", "scene", "sphere", "--dimensions", f"{n},{n},{n}", "--quiet", "-o", data)
            target = f"{0.5 / n:.6g}"
            figures = resample(adamas, folder, data, "--interface-error", target)
        yield resample_row(f"sphere {n}^3", figures, growth_text(figures, last, 8), f"{target}, half a cell")
        last = figures


def impact_rows(build, quick):
    """The impact of a projectile: its computation, and its resampling within 0.15 cm and 3 g/cm3 on the least grid, and
    within the same part of a cell on the finer ones."""
    adamas = os.path.join(build, "cli/adamas")
    last = None
    for factor in (1,) if quick else (1, 2, 4):
        dimensions = f"{32 * factor},{32 * factor},{52 * factor}"
        with tempfile.TemporaryDirectory() as folder:
            data = os.path.join(folder, "impact.vtr")
            start = time.monotonic()
            output_of(adamas, "generate", "impact", "--dimensions", dimensions, "--threads", "1", "--quiet", "-o", data)
            seconds = time.monotonic() - start
            figures = resample(adamas, folder, data, "--interface-error", f"{0.15 / factor:g}", "--field-error",
                               "density=3", "--ghost", "linear")
        size = dimensions.replace(",", "x")
        yield [f"generate impact {size}", f"{seconds:.1f} s", "", "", "<= 60 s" if factor == 1 else "", "1 thread"]
        aim = {1: "<= 5 s", 4: "<= 60 s, 8 GB"}.get(factor, "")
        yield resample_row(f"impact {size}", figures, growth_text(figures, last, 8), f"{0.15 / factor:g}", aim)
        last = figures


def cth_rows(build, quick):
    data = os.path.join(os.environ.get("ADAMAS_DATA", "../shared/data"), "material/pyvista_misc/cth.vtr")
    if not os.path.exists(data):
        note(f"bench: {data} is not there: no row for the CTH data")
        return
    with tempfile.TemporaryDirectory() as folder:
        for target in ("1%",) if quick else ("1%", "0.5%"):
            figures = resample(os.path.join(build, "cli/adamas"), folder, data, "--interface-error", target)
            yield resample_row("CTH 128x64x64", figures, "", f"{target} of the diagonal")


def print_table(rows):
    header = ["what", "adamas", "peer", "ratio, growth", "aim", "equal at"]
    widths = [max(len(r[i]) for r in [header] + rows) for i in range(len(header))]

    def line(cells):
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(cells, widths)) + " |")

    line(header)
    print("|" + "|".join("-" * (width + 2) for width in widths) + "|")
    for cells in rows:
        line(cells)
    print(flush=True)


PARTS = {"hierarchy": hierarchy_rows, "closest": closest_point_rows, "selection": selection_rows,
         "sphere": sphere_rows, "impact": impact_rows, "cth": cth_rows, "volumes": volume_rows, "frames": frame_rows, "series": series_rows,
         "scale": scale_rows, "large": large_rows}


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench", usage="%(prog)s [--quick] [--large] [PART ...]",
                                     description="Builds and runs the benchmarks; prints a table of what the project and "
                                     "its peers do, part by part. Data sets are looked for in $ADAMAS_DATA, or else in ../shared/data. Of the "
                                     "part series, what is generated and drawn, and of scale the picture, stays in folders of $ADAMAS_BENCH_DATA, where that is set.")
    parser.add_argument("build", help=argparse.SUPPRESS)
    parser.add_argument("parts", nargs="*", metavar="PART",
                        help=f"only these: {', '.join(PARTS)} (default: all but scale and large)")
    parser.add_argument("--quick", action="store_true", help="smaller grids, shorter runs")
    parser.add_argument("--large", action="store_true",
                        help="the same as the part large alone: a volume of more than 2^31 samples")
    arguments = parser.parse_intermixed_args()
    unknown = [name for name in arguments.parts if name not in PARTS]
    if unknown:
        parser.error(f"expected some of {', '.join(PARTS)}, found {unknown[0]}")
    for name in ["large"] if arguments.large else arguments.parts or [p for p in PARTS if p not in ("scale", "large")]:
        found = PARTS[name](arguments.build, arguments.quick)
        rows = list(found) if name == "cth" else some(name, found)
        if rows:
            print_table(rows)


if __name__ == "__main__":
    main()
