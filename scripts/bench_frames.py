"""Rows of scripts/bench on frames: flights towards volumes and through them."""

import json
import os
import tempfile

from bench_volumes import MEASURED, lines_of, make_buckyball, note, run_measured, store


def flight_rows(build, name, file, isovalue, frames, raw=None):
    """A flight round the middle of a volume and into it, without drawing, and changes of the isovalue in its middle."""
    flight, change = lines_of(build, "bench_frames", file, str(isovalue), str(frames), "500000", *([raw] if raw else []))
    where = (f"{frames} frames of 1024x768, at most {flight['triangles']:,} triangles, error left at most "
             f"{flight['largest_error_pixels']:.2f} pixels, with normals, 1 thread, processor seconds")
    median, slowest = flight["median"], flight["percentile_99"]
    yield [f"frames of {name}", f"{1e3 * median:.1f} ms median, {1e3 * slowest:.1f} ms at 99%", "10 ms, 33 ms (aim)",
           f"{median / 0.010:.2f}, {slowest / 0.033:.2f}", "<= 1", where]
    yield [f"frames of {name}: the first", f"{1e3 * flight['first']:.0f} ms", "", "", "", where]
    where = f"{change['triangles']:,} triangles with normals, pages in memory; Flying Edges: raw read, all samples, normals; 1 thread, processor seconds"
    peer = change["peer"]
    yield [f"another isovalue of {name}", f"{1e3 * change['adamas']:.0f} ms", f"{1e3 * peer:.0f} ms" if raw else "",
           f"{change['adamas'] / peer:.2f}" if raw else "", "<= 0.33", where]


def cold_rows(build, name, file, isovalue, frames):
    """The same flight with no page in memory at first, and room for few: frames that wait for pages, and such that do without."""
    memory = 32 << 20
    waiting, paging = lines_of(build, "bench_frames", file, str(isovalue), str(frames), "500000", "cold", str(memory))
    for part, what in ("first", "the first"), ("median", "median"), ("percentile_99", "99%"):
        yield [f"frames of {name}, pages loaded by a thread: {what}", f"{1e3 * paging[part]:.1f} ms", f"{1e3 * waiting[part]:.1f} ms waiting",
               f"{paging[part] / waiting[part]:.2f}", "",
               f"32 MiB of pages, none in memory at first; the first view is whole after {paging['frames_until_whole']} frames; "
               f"{paging['missing_median']} pages missing in the median"]


def median(values):
    return sorted(values)[len(values) // 2]


def occlusion_rows(build, name, file, isovalue, frames, folder):
    """What leaving out the hidden saves on a flight round a volume (the dissertation's table 4.5), medians of the frames."""
    found = []
    for options in [], ["--occlusion"]:
        figures = os.path.join(folder, "frames.json")
        run_measured(os.path.join(build, "cli", "adamas"), "view", file, "--isovalue", str(isovalue), "--offscreen", "--camera-path", f"orbit:{frames}",
                     "--max-triangles", "2000000", "--threads", "1", "-q", "--json", figures, *options)
        with open(figures, encoding="utf-8") as stream:
            # The first frame knows of no picture before it.
            found.append(json.load(stream)["frames"][1:])
    all_of, some = ({key: median([frame[key] for frame in of]) for key in of[0]} for of in found)
    yield [f"occlusion, {name}", f"{some['triangles']:,} triangles", f"{all_of['triangles']:,} without", f"{some['triangles'] / all_of['triangles']:.2f}", "",
           f"{some['occluded_diamonds']:,} diamonds hidden of {some['occlusion_queries']:,} looked up in a frame; update {1e3 * some['update_seconds']:.0f} ms, "
           f"{1e3 * all_of['update_seconds']:.0f} without; {frames} frames of 1024x768, error 1 pixel"]


def drawing_rows(build, name, file, isovalue):
    """Drawing a surface from its chunks, beside one plain indexed draw of the same triangles."""
    found = [lines_of(build, "bench_drawing", file, str(isovalue), "500000")[0] for _ in range(3)]
    ratios = sorted(line["plain"] / line["adamas"] for line in found)
    line = found[0]
    ours, plain = (median([each[key] for each in found]) for key in ("adamas", "plain"))
    yield [f"drawing, {name}", f"{1e3 * ours:.1f} ms", f"{1e3 * plain:.1f} ms (one plain indexed draw)", f"{ratios[1]:.2f}", ">= 0.9",
           f"{line['triangles']:,} triangles in {line['chunks']:,} chunks, {line['draw_calls']} commands; 1024x768, without updates; processor seconds of all "
           f"threads, medians of 15 pictures; ratios of three runs {ratios[0]:.2f} to {ratios[2]:.2f}; {line['drawn_by']}"]


def frame_rows(build, quick):
    with tempfile.TemporaryDirectory() as folder:
        side = 256 if quick else 512
        file = os.path.join(folder, "ball.adm")
        ball = make_buckyball(build, folder, side)
        store(build, ball, file)
        yield from flight_rows(build, f"buckyball {side}^3", file, 80.5, 60 if quick else 600, ball.replace(".nhdr", ".raw"))
        yield from cold_rows(build, f"buckyball {side}^3", file, 80.5, 60 if quick else 200)
        yield from drawing_rows(build, f"buckyball {side}^3", file, 80.5)
        yield from occlusion_rows(build, f"buckyball {side}^3", file, 80.5, 24, folder)
        root = os.path.join(os.environ.get("ADAMAS_DATA", "../shared/data"), "volume")
        for path, options, isovalue in [*MEASURED[:2], MEASURED[4]]:
            data, name = os.path.join(root, path), os.path.basename(path)
            if "*" not in data and not os.path.exists(data):
                note(f"bench: {data} is not there: no rows for it")
                continue
            store(build, data, file, *options)
            yield from flight_rows(build, name, file, isovalue, 60 if quick else 600)
            yield from drawing_rows(build, name, file, isovalue)
            yield from occlusion_rows(build, name, file, isovalue, 24, folder)
