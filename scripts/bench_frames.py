"""Rows of scripts/bench on frames: flights towards volumes and through them."""

import json
import math
import os
import tempfile

from bench_volumes import MEASURED, make_buckyball, note, run_measured, store

ADAMAS = "cli/adamas"


def spiral(path, low, high, frames):
    """A flight once round the middle of a box and into it, with the eye on the middle."""
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    size = max(b - a for a, b in zip(low, high))
    with open(path, "w", encoding="utf-8") as file:
        for n in range(frames):
            part = n / max(1, frames - 1)
            angle, away = 2 * math.pi * part, size * (1.4 - part)
            eye = [middle[0] + away * math.cos(angle), middle[1] + away * math.sin(angle), middle[2] + 0.25 * size * math.sin(2 * angle)]
            print(*eye, *middle, 0, 0, 1, file=file)


def box_of(build, file, folder):
    figures = os.path.join(folder, "info.json")
    run_measured(os.path.join(build, ADAMAS), "info", file, "-q", "--json", figures)
    with open(figures, encoding="utf-8") as stream:
        box = json.load(stream)["box"]
    return box[0::2], box[1::2]


def flight_rows(build, name, file, isovalue, frames, folder):
    path, figures = os.path.join(folder, "path.txt"), os.path.join(folder, "frames.json")
    spiral(path, *box_of(build, file, folder), frames)
    run_measured(os.path.join(build, ADAMAS), "view", file, "--isovalue", str(isovalue), "--offscreen", "--camera-path", path, "--threads", "1",
                 "--max-triangles", "500000", "-q", "--json", figures)
    with open(figures, encoding="utf-8") as stream:
        found = json.load(stream)
    of = found["frames"]

    def at(key, quantile):
        values = sorted(frame[key] for frame in of)
        return values[min(len(values) - 1, int(quantile * len(values)))]

    where = f"{frames} frames of 1024x768, at most {max(f['triangles'] for f in of):,} triangles, error left at most {max(f['largest_error_pixels'] for f in of):.2f} pixels, 1 thread"
    median, slowest = at("update_seconds", 0.5), at("update_seconds", 0.99)
    yield [f"frames of {name}: the mesh", f"{1e3 * median:.0f} ms median, {1e3 * slowest:.0f} ms at 99%", "10 ms, 33 ms (aim)",
           f"{median / 0.010:.1f}, {slowest / 0.033:.1f}", "<= 1", where]
    yield [f"frames of {name}: the first", f"{1e3 * of[0]['update_seconds']:.0f} ms", "", "", "", where]
    yield [f"frames of {name}: normals", f"{1e3 * at('normal_seconds', 0.5):.0f} ms median", "", "", "", where]
    yield [f"frames of {name}: drawing", f"{1e3 * at('draw_seconds', 0.5):.0f} ms median", "", "", "", found["drawn_by"]]


def frame_rows(build, quick):
    with tempfile.TemporaryDirectory() as folder:
        side = 256 if quick else 512
        file = os.path.join(folder, "ball.adm")
        store(build, make_buckyball(build, folder, side), file)
        yield from flight_rows(build, f"buckyball {side}^3", file, 80.5, 60 if quick else 600, folder)
        root = os.path.join(os.environ.get("ADAMAS_DATA", "../shared/data"), "volume")
        for path, options, isovalue in MEASURED[:2]:
            data, name = os.path.join(root, path), os.path.basename(path)
            if "*" not in data and not os.path.exists(data):
                note(f"bench: {data} is not there: no rows for it")
                continue
            store(build, data, file, *options)
            yield from flight_rows(build, name, file, isovalue, 60 if quick else 120, folder)
