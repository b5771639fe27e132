"""Rows of scripts/bench on a volume of more than 2^31 samples. Where an answer is not right it ends."""

import json
import math
import os
import sys
import tempfile

from bench_volumes import bytes_text, million, run_measured, store

LARGE, QUICK = (2048, 2048, 520), (512, 512, 260)
BALL, ISOVALUE = 24, 20.5


def ball_value(distance):
    return max(0, round(255 - 10 * distance))


def ball_centres(dimensions):
    """Near the first sample, and at the end, where the places of samples are beyond 2^31."""
    nx, ny, nz = dimensions
    return (100, 100, 100), (nx - 100, ny - 100, nz - 1 - BALL)


def write_sparse(path, dimensions):
    """uint8 samples, nearly all zero and not on the disk: balls about the centres."""
    nx, ny, nz = dimensions
    around = range(-BALL, BALL + 1)
    with open(path, "wb") as file:
        file.truncate(nx * ny * nz)
        for x, y, z in ball_centres(dimensions):
            for k in around:
                for j in around:
                    file.seek(x - BALL + nx * (y + j + ny * (z + k)))
                    file.write(bytes(ball_value(math.hypot(i, j, k)) for i in around))


def check_samples(dimensions, raw, restored, box):
    nx, ny, _ = dimensions
    (x0, x1), (y0, y1), (z0, z1) = box
    with open(raw, "rb") as file, open(restored, "rb") as found:
        for k in range(z0, z1 + 1):
            for j in range(y0, y1 + 1):
                file.seek(x0 + nx * (j + ny * k))
                if file.read(x1 - x0 + 1) != found.read(x1 - x0 + 1):
                    sys.exit(f"bench: large: expected the samples of the file in row {j}, {k}, found others")
        if found.read(1) != b"":
            sys.exit("bench: large: expected the samples of a region, found more")


def distance_from_spheres(path, centres):
    """The greatest distance of the vertices of an .obj file from spheres of the isovalue, which they must cover."""
    radius = (255 - ISOVALUE) / 10
    greatest, vertices, triangles = 0, [0] * len(centres), 0
    with open(path, encoding="utf-8") as file:
        for line in file:
            kind, _, rest = line.partition(" ")
            if kind == "v":
                point = [float(x) for x in rest.split()[:3]]
                distance, nearest = min((abs(math.dist(point, c) - radius), n) for n, c in enumerate(centres))
                greatest = max(greatest, distance)
                vertices[nearest] += 1
            triangles += kind == "f"
    # By Euler's formula.
    if 0 in vertices or triangles != 2 * sum(vertices) - 4 * len(centres):
        sys.exit(f"bench: large: expected {len(centres)} closed spheres, found {vertices} vertices, {triangles} triangles")
    return greatest


def measured(command, store_path, *options):
    """Figures of a command on the store, with its peak memory."""
    figures = store_path + ".json"
    adamas, name = command
    _, peak = run_measured(adamas, name, store_path, *options, "-q", "--json", figures)
    with open(figures, encoding="utf-8") as file:
        return json.load(file) | {"peak_memory_bytes": peak}


def row(what, figures, at, good):
    return [f"large: {what}", f"{figures['seconds']:.2f} s, {bytes_text(figures['peak_memory_bytes'])}", "", good, "", at]


def surface_row(adamas, path, what, centres, *options):
    error = 0.2
    mesh = path + ".obj"
    figures = measured((adamas, "isosurface"), path, "--isovalue", str(ISOVALUE), "--error", f"{error}voxels", "--plain", *options,
                       "-o", mesh)
    distance = distance_from_spheres(mesh, centres)
    # Samples are rounded, by up to 0.05 voxel of the distance, and linear between, which is as much again.
    if distance > error + 0.1:
        sys.exit(f"bench: large: expected vertices within {error + 0.1} voxels of the spheres, found one at {distance}")
    return row(f"isosurface, {what}", figures, f"isosurface error {figures['isosurface_error_estimate']:.3g} (wanted {error})",
               f"{figures['triangles']:,} triangles, closed, vertices within {distance:.3f} voxel of spheres")


def large_rows(build, quick):
    """A sparse file stored and verified; a region about each ball restored and compared; surfaces of the last ball's
    region and of all."""
    adamas = os.path.join(build, "cli/adamas")
    dimensions = QUICK if quick else LARGE
    centres = ball_centres(dimensions)
    with tempfile.TemporaryDirectory() as folder:
        raw, path, part = (os.path.join(folder, name) for name in ("large.raw", "large.adm", "part.raw"))
        write_sparse(raw, dimensions)
        found = store(build, raw, path, "--dimensions", ",".join(str(n) for n in dimensions), "--type", "uint8",
                      "--scratch", folder)
        bound = 2**30 + 64 * dimensions[0] * dimensions[1]
        at = f"{'x'.join(str(n) for n in dimensions)} uint8, {found['samples']:,} samples, all threads"
        yield row("store", found, at, f"{million(found['samples'] / found['seconds'])}, {os.path.getsize(path):,} bytes, "
                                      f"memory / bound {found['peak_memory_bytes'] / bound:.2f}")
        figures = measured((adamas, "verify"), path)
        yield row("verify", figures, "the same store, all threads", f"{figures['pages']:,} pages, all sound")
        for centre in centres:
            box = [(max(c - 40, 0), min(c + 39, n - 1)) for c, n in zip(centre, dimensions)]
            region = ",".join(f"{low},{high}" for low, high in box)
            figures = measured((adamas, "restore"), path, "--region", region, "-o", part)
            check_samples(dimensions, raw, part, box)
            yield row("restore", figures, f"region {region}", "bit for bit")
        yield surface_row(adamas, path, f"region {region}", centres[-1:], "--region", region)
        yield surface_row(adamas, path, "all", centres)
