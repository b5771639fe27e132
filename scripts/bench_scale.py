"""Rows of scripts/bench on how the cost of resampling labels grows: with cells, with bodies, and with materials round one point."""

import array
import json
import math
import os
import random
import resource
import subprocess
import sys
import tempfile

from bench_volumes import bytes_text

# Processor seconds of one run, or seconds of one mesh of CGAL with all its trials. Beyond them a row says "none".
SECONDS, QUICK_SECONDS = 600, 60
CELLS, QUICK_CELLS = (16, 32, 64, 128), (16, 32)
BODIES, QUICK_BODIES = (1, 10, 100, 1000), (1, 10)
MATERIALS, QUICK_MATERIALS = (3, 10, 30), (3, 10)
# Of a grain, along an axis; of the grids of the other rows.
GRAIN, FIXED, QUICK_FIXED = 8, 48, 24


def grains(n, side, materials, seed=1):
    """Labels of n^3 cells: Voronoi cells of a random point in each cube of side^3 cells, of random materials. The nearest point is
    looked for in the 27 cubes round a cell's own."""
    chance = random.Random(seed)
    count = n // side
    seeds = {(i, j, k): (side * (i + chance.random()), side * (j + chance.random()), side * (k + chance.random()), chance.randrange(materials))
             for k in range(count) for j in range(count) for i in range(count)}
    labels = array.array("H", bytes(2 * n**3))
    for (i, j, k) in seeds:
        near = [seeds[at] for at in ((i + a, j + b, k + c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)) if at in seeds]
        for z in range(k * side, (k + 1) * side):
            for y in range(j * side, (j + 1) * side):
                row = [(sx, (sy - y - 0.5)**2 + (sz - z - 0.5)**2, m) for sx, sy, sz, m in near]
                first = n * (y + n * z)
                for x in range(i * side, (i + 1) * side):
                    labels[first + x] = min(((sx - x - 0.5)**2 + d, m) for sx, d, m in row)[1]
    return labels


def voronoi(n, count, seed=1):
    """Labels of n^3 cells: that of the nearest of so many random points, each a material of its own. One of them is a ball in another material."""
    if count == 1:
        centre, radius = n / 2, 0.35 * n
        return array.array("H", (int((x + 0.5 - centre)**2 + (y + 0.5 - centre)**2 + (z + 0.5 - centre)**2 < radius**2)
                                 for z in range(n) for y in range(n) for x in range(n)))
    chance = random.Random(seed)
    buckets = max(1, round((count / 2)**(1 / 3)))
    width = n / buckets
    seeds = {}
    for m in range(count):
        point = [n * chance.random() for _ in range(3)]
        seeds.setdefault(tuple(int(p / width) for p in point), []).append((*point, m))
    labels = array.array("H", bytes(2 * n**3))
    for k in range(buckets):
        for j in range(buckets):
            for i in range(buckets):
                near, reach = [], 1
                while not near:
                    around = range(-reach, reach + 1)
                    near = [s for a in around for b in around for c in around for s in seeds.get((i + a, j + b, k + c), [])]
                    reach += 1
                cells = [range(math.ceil(width * q - 0.5), math.ceil(width * (q + 1) - 0.5)) for q in (i, j, k)]
                for z in cells[2]:
                    for y in cells[1]:
                        row = [(sx, (sy - y - 0.5)**2 + (sz - z - 0.5)**2, m) for sx, sy, sz, m in near]
                        for x in cells[0]:
                            labels[x + n * (y + n * z)] = min(((sx - x - 0.5)**2 + d, m) for sx, d, m in row)[1]
    return labels


def sectors(n, count):
    """Labels of n^3 cells: cones that meet in the middle, round directions that are spread evenly over the sphere."""
    turn = math.pi * (3 - math.sqrt(5))
    directions = []
    for m in range(count):
        z = 1 - (2 * m + 1) / count
        r = math.sqrt(1 - z * z)
        directions.append((r * math.cos(turn * m), r * math.sin(turn * m), z))
    labels = array.array("H")
    for k in range(n):
        for j in range(n):
            for i in range(n):
                p = [c + 0.5 - n / 2 for c in (i, j, k)]
                labels.append(max(range(count), key=lambda m, p=p: sum(a * b for a, b in zip(directions[m], p))))
    return labels


def write_labels(path, n, labels):
    if sys.byteorder == "big":
        labels.byteswap()
    with open(path, "wb") as file:
        file.write(f"NRRD0004\ntype: uint16\ndimension: 3\nsizes: {n} {n} {n}\nspacings: 1 1 1\nendian: little\nencoding: raw\n\n".encode())
        file.write(labels.tobytes())


def run_within(seconds, *command):
    """Runs a command; None where it takes more processor seconds, else its exit status."""
    print("bench: " + " ".join(os.path.basename(command[0]) if i == 0 else a for i, a in enumerate(command)), file=sys.stderr, flush=True)
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))  # noqa: E731
    status = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=limit, check=False).returncode
    return status if status >= 0 else None


def resampled(adamas, folder, data, seconds):
    figures = os.path.join(folder, "figures.json")
    status = run_within(seconds, adamas, "resample", data, "--labels", data, "--interface-error", "1voxels", "--threads", "1", "--quiet",
                        "--json", figures)
    if status not in (0, 3):
        return None
    with open(figures, encoding="utf-8") as file:
        return json.load(file)


def reconstructed(adamas, folder, data, seconds, *options):
    """The figures of interfaces alone; None where there are none in time."""
    figures = os.path.join(folder, "interfaces.json")
    if run_within(seconds, adamas, "reconstruct", data, "--labels", data, "--threads", "1", "--quiet", "--json", figures, *options) != 0:
        return None
    with open(figures, encoding="utf-8") as file:
        return json.load(file)


def surfaces_by_vtk(build, data, seconds):
    """Seconds of discrete Flying Edges, without and with smoothing; None where they are not done in time."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))  # noqa: E731
    done = subprocess.run([os.path.join(build, "tests/benchmarks/bench_label_surfaces"), data], stdout=subprocess.PIPE, preexec_fn=limit, check=False)
    return json.loads(done.stdout) if done.returncode == 0 else None


def meshed_by_others(adamas, folder, data, seconds):
    """The rows of Mesh_3, straight from the labels, and of TetGen, which gets the input's interfaces (ours where it fails with these), of `adamas compare`; None where there is none in time."""
    table = os.path.join(folder, "compare.json")
    run_within(8 * seconds, adamas, "compare", data, "--labels", data, "--interface-error", "1voxels", "--threads", "1", "--quiet",
               "--reference", "tetgen,mesh3", "--time-limit", str(seconds), "--json", table)
    if not os.path.exists(table):
        return None, None
    with open(table, encoding="utf-8") as file:
        rows = [r for r in json.load(file)["meshes"] if not r["failure"]]
    first = lambda found: found[0] if found else None  # noqa: E731
    return first([r for r in rows if "Mesh_3" in r["name"] and "label" in r["name"]]), first([r for r in rows if r["name"].startswith("TetGen")])


def ours_text(figures):
    return f"{figures['processor_seconds']:.2f} s, {bytes_text(figures['peak_memory_bytes'])}" if figures else "none"


def peer_text(row):
    return f"{row['seconds']:.2f} s, {bytes_text(row['peak_memory_bytes'])}, {row['tetrahedra']:,} tetrahedra" if row else "none"


def growth(last, figures, factor):
    if last is None or figures is None:
        return ""
    seconds = math.log(figures["processor_seconds"] / last["processor_seconds"]) / math.log(factor)
    memory = math.log(figures["peak_memory_bytes"] / last["peak_memory_bytes"]) / math.log(factor)
    return f"time ~ n^{seconds:.2f}, memory ~ n^{memory:.2f}"


class Curve:
    """Seconds of one program against what grows."""

    def __init__(self, name):
        self.name, self.x, self.y = name, [], []

    def add(self, x, seconds):
        if seconds is not None:
            self.x.append(x)
            self.y.append(seconds)


def draw(build, name, lines):
    """Processor seconds against what grows, both logarithmic, where pictures are kept."""
    folder = os.environ.get("ADAMAS_BENCH_DATA")
    if folder is None:
        return
    os.makedirs(folder, exist_ok=True)
    described = [{"title": "", "x": title, "y": "processor seconds", "logarithmic": True, "logarithmic_x": True,
                  "series": [{"name": c.name, "x": c.x, "y": c.y, "dashed": not c.name.startswith("adamas")} for c in curves if c.x]}
                 for title, curves in lines]
    path = os.path.join(folder, name + ".json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump([d for d in described if d["series"]], file)
    subprocess.run([os.path.join(build, "tests/benchmarks/bench_plots"), path, os.path.join(folder, name + ".png")], check=True)


def scale_rows(build, quick):
    """How much longer it takes, and how much more memory, where there are more cells, bodies, or materials that meet."""
    adamas = os.path.join(build, "cli/adamas")
    limit, fixed = (QUICK_SECONDS, QUICK_FIXED) if quick else (SECONDS, FIXED)
    families = [("cells", [(n**3, n, lambda n=n: grains(n, GRAIN, 4)) for n in (QUICK_CELLS if quick else CELLS)]),
                ("bodies", [(c, fixed, lambda c=c: voronoi(fixed, c)) for c in (QUICK_BODIES if quick else BODIES)]),
                ("materials round a point", [(c, fixed, lambda c=c: sectors(fixed, c)) for c in (QUICK_MATERIALS if quick else MATERIALS)])]
    lines = []
    for name, steps in families:
        last = None
        curves = [Curve(c) for c in ("adamas", "Mesh_3 of labels", "TetGen", "adamas reconstruct", "adamas, smoothed", "Flying Edges", "Flying Edges, smoothed")]
        for size, n, make in steps:
            with tempfile.TemporaryDirectory() as folder:
                data = os.path.join(folder, "labels.nrrd")
                write_labels(data, n, make())
                figures = resampled(adamas, folder, data, limit)
                cgal, tetgen = meshed_by_others(adamas, folder, data, limit)
                plain, smooth = (reconstructed(adamas, folder, data, limit, *o) for o in ((), ("--smooth-labels",)))
                edges = surfaces_by_vtk(build, data, limit)
            of = lambda row, key="processor_seconds": row and row[key]  # noqa: E731
            seconds = (of(figures), of(cgal, "seconds"), of(tetgen, "seconds"), of(plain), of(smooth), of(edges, "seconds"), of(edges, "smoothed_seconds"))
            for curve, y in zip(curves, seconds):
                curve.add(size, y)
            at = f"{n}^3 cells, error of 1 voxel, 1 thread"
            if figures:
                at += f": {figures['bodies']:,} bodies, {figures['tetrahedra']:,} tetrahedra"
            yield [f"scale: {size:,} {name}", ours_text(figures), f"Mesh_3 of labels: {peer_text(cgal)}; TetGen: {peer_text(tetgen)}",
                   growth(last and last[1], figures, size / last[0] if last else 1), "", at]
            if edges:
                for what, ours, theirs in (("interfaces", plain, edges["seconds"]), ("smoothed interfaces", smooth, edges["smoothed_seconds"])):
                    yield [f"scale: {size:,} {name}, {what}", ours_text(ours), f"discrete Flying Edges: {theirs:.2f} s, {edges['triangles']:,} triangles",
                           f"{theirs / ours['processor_seconds']:.2f}" if ours else "", "", f"{n}^3 cells, 1 thread"]
            if figures:
                last = size, figures
        lines.append((name, curves))
    draw(build, "scale", lines)
