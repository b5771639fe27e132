"""Rows of scripts/bench on series of volumes: their files, what playing them reads and takes, and how their samples change along
time, as the dissertation's table 5.1 and figures 5.7 to 5.9."""

import contextlib
import glob
import json
import os
import subprocess
import tempfile

from bench_volumes import lines_of, note, run_measured

MEGA = 10**6
READ_STEPS = (10, 15, 20)
INTERPOLATION_VOXELS = ("0.7", "2", "4")
ERROR = "0.7voxels"
FINE_ERROR = "0.05voxels"  # at which the large series has 200,000 triangles
RUNS = 3
SAMPLE_BYTES = {"uint8": 1, "uint16": 2, "float32": 4}
PAGE_SAMPLES = 4096


class Series:
    """A series, how it is had and stored, and the surface that is played."""

    def __init__(self, name, isovalue, inputs, *options, generate=None, aim=None):
        self.name, self.isovalue, self.inputs, self.options, self.generate, self.aim = name, isovalue, inputs, list(options), generate, aim
        self.folder = name.replace(" ", "-").replace("^3", "")


def moving_bodies(side, steps, sample):
    return ["generate", "scene", "moving", "--dimensions", ",".join([side] * 3), "--steps", steps, "--volume", sample, "-o", "moving.pvd"]


def large_series(quick):
    """Of which nothing but steps is measured."""
    side, steps = ("128", "4") if quick else ("512", "8")
    return Series(f"moving {side}^3 x {steps} uint16", 0, ["moving.pvd"], aim=0.15, generate=moving_bodies(side, steps, "uint16"))


def all_series(quick):
    side, steps = ("64", "20") if quick else ("128", "100")
    large, moving = ("64", "20") if quick else ("256", "64")
    data = os.environ.get("ADAMAS_DATA", "../shared/data")
    yield Series(f"mixing {side}^3 x {steps}", 12, ["mixing.pvd"], "--array", "density", aim=0.3,
                 generate=["generate", "mixing", "--dimensions", side, "--steps", steps, "-o", "mixing.pvd"])
    for sample, aim in (("uint16", 0.15), ("uint8", None)):
        yield Series(f"moving {large}^3 x {moving} {sample}", 0, ["moving.pvd"], aim=aim, generate=moving_bodies(large, moving, sample))
    yield Series("ViscousFingers 64^3 x 24", 20, sorted(glob.glob(os.path.join(data, "timeseries/ttk_ViscousFingers/run01/*.vti"))))
    yield Series("spcth 64^3 x 9", 127.5, sorted(glob.glob(os.path.join(data, "derived/spcth_vf/*_vf3_*.raw"))), "--dimensions", "64,64,64", "--type",
                 "uint8", "--spacing", "0.78125,0.78125,0.78125")


@contextlib.contextmanager
def folder_of(series):
    """Where a series is generated, and its figures are drawn: a folder of $ADAMAS_BENCH_DATA, which stays, or one for the time being."""
    kept = os.environ.get("ADAMAS_BENCH_DATA")
    if kept is None:
        with tempfile.TemporaryDirectory() as folder:
            yield folder
        return
    folder = os.path.abspath(os.path.join(kept, series.folder))
    os.makedirs(folder, exist_ok=True)
    yield folder


class Bench:
    """The commands, run on one series in its folder."""

    def __init__(self, build, folder, series):
        self.build, self.folder, self.series = build, folder, series
        self.adamas = os.path.abspath(os.path.join(build, "cli/adamas"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def figures(self, *command):
        """What a command says of itself, and its processor seconds."""
        figures = self.path("figures.json")
        seconds, _ = run_measured(self.adamas, *command, "--threads", "1", "-q", "--json", figures)
        with open(figures, encoding="utf-8") as file:
            return json.load(file) | {"processor_seconds": seconds}

    def generate(self):
        if self.series.generate is None:
            return self.series.inputs
        *command, output = self.series.generate
        path = self.path(output)
        if not os.path.exists(path):
            run_measured(self.adamas, *command, path, "-q")
        return [path]

    def store(self, name, inputs, *options):
        path = self.path(name)
        if os.path.exists(path):
            os.remove(path)
        return path, self.figures("store", *inputs, *self.series.options, *options, "-o", path)

    def play(self, file, read_steps, error=ERROR):
        return self.figures("play", file, f"--isovalue={self.series.isovalue}", "--error", error, "--ahead", "0", "--read-steps", str(read_steps))

    def timed(self, file, error=ERROR):
        """Playing and contouring by turns."""
        return [(self.play(file, READ_STEPS[0], error), self.contours(file)) for _ in range(RUNS)]

    def contours(self, file):
        return lines_of(self.build, "bench_series_contour", file, str(self.series.isovalue), self.path("step.raw"))

    def draw(self, name, plots):
        """Into a picture, where the folder stays."""
        if os.environ.get("ADAMAS_BENCH_DATA") is None:
            return
        with open(self.path(name + ".json"), "w", encoding="utf-8") as file:
            json.dump(plots, file)
        program = os.path.join(self.build, "tests/benchmarks/bench_plots")
        subprocess.run([program, self.path(name + ".json"), self.path(name + ".png")], check=True)


def mega(count):
    return f"{count / MEGA:.1f} MB" if count >= MEGA else f"{count / 1000:.0f} kB"


def whole(zstd, size):
    """What zstd makes of some pages, for all, whose bytes are so many."""
    return {key: count * size // zstd["input"] for key, count in zstd.items() if key != "of"}


def least_by_page(zstd):
    return f"zstd -19 of each page: its steps one by one {mega(zstd['alone'])}, in turn {mega(zstd['in_turn'])}, sample by sample {mega(zstd['interleaved'])}"


def file_rows(name, coded, plain, zstd, aim="<= 0.54"):
    """The file beside one that is not compressed, and beside what zstd makes of the same: samples, and errors and ranges of all."""
    parts = f"{mega(coded['bytes_data'])} of samples, {mega(coded['bytes_errors'])} of errors and ranges"
    yield [f"file of {name}", mega(coded["bytes_file"]), f"uncompressed {mega(plain['bytes_file'])}",
           f"{coded['bytes_file'] / plain['bytes_file']:.3f}", aim, f"{parts}; errors and ranges are coded in both"]
    sample = SAMPLE_BYTES[coded["type"]]
    of = {"samples": whole(zstd["samples"], coded["bytes_input"]),
          "errors and ranges": whole(zstd["errors and ranges"], coded["bytes_input"] * (1 + 2 * sample) // sample)}
    least = sum(part["least"] for part in of.values())
    yield [f"file of {name}", mega(coded["bytes_file"]), f"zstd {mega(least)}", f"{coded['bytes_file'] / least:.3f}", "< 1",
           ", ".join(f"{mega(part['least'])} of {what}" for what, part in of.items()) + ", without directory and checksums"]
    for what, key in (("samples", "bytes_data"), ("errors and ranges", "bytes_errors")):
        yield [f"{what} of {name}", mega(coded[key]), f"zstd {mega(of[what]['least'])}", f"{coded[key] / of[what]['least']:.3f}", "< 1",
               least_by_page(of[what])]


def memory_text(read_steps, sample):
    """What a page takes in memory: decoded, at one step, its samples and what they carry along, and its errors and ranges; and as
    it was read."""
    size = read_steps * PAGE_SAMPLES * sample
    return (f"in memory a page has {PAGE_SAMPLES * sample + 20:,} bytes of samples and {PAGE_SAMPLES * (2 * sample + 1):,} of errors and ranges for "
            f"each step that is decoded, and {size * 3 // 4:,} to {size * 5 // 4:,} as read")


def reading_row(series, read_steps, sample, coded, plain):
    """What a whole play reads, of both files: table 5.1."""
    def text(played):
        return f"{played['page_faults']:,} reads, {mega(played['bytes_read'])} ({played['part_read']:.1%})"
    return [f"play {series.name}, {read_steps} steps a read", text(coded), f"uncompressed {text(plain)}", f"{coded['bytes_read'] / plain['bytes_read']:.3f}",
            f"<= {series.aim:.0%} of the file" if series.aim and read_steps == READ_STEPS[0] else "",
            f"{coded['triangles_mean']:,.0f} triangles a step, error 0.7 voxel; {memory_text(read_steps, sample)}"]


def needs_row(name, least, found):
    """What a surface needs at all, read page by page, and of what these bytes are."""
    def size(which):
        return found[which]["samples"] + found[which]["bounds"]
    crossed = found["crossed"]
    return [f"play {name}, no read ahead", f"{least['page_faults']:,} reads, {mega(least['bytes_read'])} ({least['part_read']:.1%})", "", "", "",
            f"{crossed['pages']:,} pages and steps that the surface of all samples crosses {mega(size('crossed'))} ({mega(crossed['samples'])} of samples, "
            f"{mega(crossed['bounds'])} of errors and ranges), what they are predicted from {mega(size('in space'))} and in time {mega(size('in time'))}, "
            f"directory, tables and copies {mega(found['others'])}, pages that are not needed {mega(size('not needed'))}"]


def median(values):
    return sorted(values)[len(values) // 2]


def time_row(series, played, contoured, error=ERROR):
    """Runs of both by turns: processor seconds of the whole run, and of Flying Edges with its reading."""
    steps = len(contoured[0])
    ours = [p["processor_seconds"] / steps for p in played]
    peer = [sum(line["processor_seconds"] for line in lines) / steps for lines in contoured]
    ratios = sorted(a / b for a, b in zip(ours, peer))
    triangles = sum(line["triangles"] for line in contoured[0]) / steps
    return [f"step of {series.name}, {error}", f"{1e3 * median(ours):.1f} ms", f"raw + Flying Edges {1e3 * median(peer):.1f} ms", f"{median(ratios):.2f}",
            "<= 0.5" if played[0]["triangles_mean"] >= 2e5 or series.aim else "",
            f"{played[0]['triangles_mean']:,.0f} triangles against {triangles:,.0f}, with normals, 1 thread, processor seconds; ratios of {len(ratios)} "
            f"runs {ratios[0]:.2f} to {ratios[-1]:.2f}; at most {1e3 * median([max(f['seconds'] for f in p['frames']) for p in played]):.0f} ms a step"]


def sums(values):
    total, result = 0, []
    for value in values:
        total += value
        result.append(total)
    return result


def play_plots(plays, value, y, part=0):
    """A plot for each length of reads, of the coded and of the uncompressed file: of frames with at least this part of the most triangles."""
    def line(name, played, dashed):
        least = part * max(f["triangles"] for f in played["frames"])
        frames = [f for f in played["frames"] if f["triangles"] >= least]
        return {"name": name, "x": [f["step"] for f in frames], "y": value(frames), "dashed": dashed}
    return [{"title": f"{steps} steps a read", "x": "step", "y": y, "series": [line("compressed", coded, False), line("uncompressed", plain, True)]}
            for steps, (coded, plain) in plays.items()]


def draw_plays(bench, plays, contoured):
    bench.draw("faults", play_plots(plays, lambda frames: sums(f["page_faults"] for f in frames), "reads of the file so far"))
    bench.draw("bytes", play_plots(plays, lambda frames: sums(f["bytes_read"] / MEGA for f in frames), "MB read so far"))
    # As the dissertation, without the first steps, which have few triangles.
    bench.draw("rates", play_plots(plays, lambda frames: [1 / f["seconds"] for f in frames], "frames per second", part=0.1))
    frames = plays[READ_STEPS[0]][0]["frames"]
    bench.draw("times", [{"title": bench.series.name, "x": "step", "y": "ms", "series": [
        {"name": "play, error 0.7 voxel", "x": [f["step"] for f in frames], "y": [1e3 * f["seconds"] for f in frames]},
        {"name": "raw + Flying Edges, all samples", "x": [c["step"] for c in contoured], "y": [1e3 * c["seconds"] for c in contoured], "dashed": True}]}])


def coefficient_table(name, found):
    """How many samples, differences along time and coded residuals are 0: figure 5.9."""
    def part(counts, most):
        return sum(n for magnitude, n in counts.items() if int(magnitude) <= most) / sum(counts.values())
    for what, label in (("differences", "second differences along time"), ("residuals", "residuals as coded")):
        yield [f"coefficients of {name}: {label} that are 0", f"{part(found[what], 0):.1%}", f"samples {part(found['samples'], 0):.1%}", "", "",
               f"at most 1: {part(found[what], 1):.1%}; greatest {max(map(int, found[what]))}"]


def draw_coefficients(bench, found):
    def line(name, counts, dashed=False):
        return {"name": name, "x": sorted(map(int, counts)), "y": [counts[str(m)] for m in sorted(map(int, counts))], "dashed": dashed}
    lines = [line("samples", found["samples"]), line("second differences along time", found["differences"]),
             line("residuals as coded", found["residuals"], True)]
    bench.draw("coefficients", [{"title": bench.series.name, "x": "magnitude", "y": "number", "logarithmic": True, "series": lines}])


def one_by_one_row(bench, inputs, coded):
    """Each step a store of its own."""
    total = 0
    for step in range(coded["steps"]):
        part = [inputs[step]] if len(inputs) > 1 else [bench.path(f"{os.path.basename(inputs[0])[:-4]}_{step:04d}.vti")]
        total += bench.store("step.adm", part)[1]["bytes_file"]
    return [f"file of {bench.series.name}", mega(coded["bytes_file"]), f"each step by itself {mega(total)}", f"{coded['bytes_file'] / total:.3f}", "< 1",
            f"{coded['steps']} stores"]


def gradient_rows(bench, inputs):
    """Both files with gradients, as the dissertation's are."""
    files = [bench.store(name, inputs, "--gradients", *options) for name, options in (("gradients.adm", []), ("plain_gradients.adm", ["--coding", "none"]))]
    (coded, of_coded), (plain, of_plain) = files
    yield [f"file of {bench.series.name} with gradients", mega(of_coded["bytes_file"]), f"uncompressed {mega(of_plain['bytes_file'])}",
           f"{of_coded['bytes_file'] / of_plain['bytes_file']:.3f}", "<= 0.54", f"{mega(of_coded['bytes_gradients'])} of gradients"]
    # Two bytes more for each sample.
    row = reading_row(bench.series, READ_STEPS[0], SAMPLE_BYTES[of_coded["type"]] + 2, *(bench.play(file, READ_STEPS[0]) for file in (coded, plain)))
    yield [row[0] + ", with gradients", *row[1:4], "", row[5]]


def interpolation_rows(build, name, file, isovalue, steps, threads):
    """Points and normals by the vertex shader beside the processor, over the last steps, and how many steps a window shows: table 5.2."""
    found = lines_of(build, "bench_interpolation", file, str(isovalue), str(max(0, steps - 9)), str(steps - 1), str(threads), *INTERPOLATION_VOXELS)
    for voxels in map(float, INTERPOLATION_VOXELS):
        line = {(each["row"], each["by"]): each for each in found if each["voxels"] == voxels}
        by_shader, by_processor = line["interpolation", "shader"], line["interpolation", "processor"]
        played = [line["played", by] for by in ("shader", "processor")]
        yield [f"step of {name} by the shader, {voxels:g} voxels", f"{1e3 * by_shader['worked_out']:.0f} ms",
               f"by the processor {1e3 * by_processor['worked_out']:.0f} ms", f"{by_shader['worked_out'] / by_processor['worked_out']:.2f}", "",
               f"{by_shader['triangles']:,} triangles; a picture {1e3 * by_shader['picture']:.0f} and {1e3 * by_processor['picture']:.0f} ms; played "
               f"{played[0]['pictures_per_second']:.0f} and {played[1]['pictures_per_second']:.0f} pictures/s (aim 30 at 1 M triangles on a graphics device), "
               f"{played[0]['steps_per_second']:.1f} and {played[1]['steps_per_second']:.1f} steps/s; by the clock, {threads} threads; {by_shader['drawn_by']}"]


def rows_of(bench):
    series, inputs = bench.series, bench.generate()
    coded_file, coded = bench.store("coded.adm", inputs)
    plain_file, plain = bench.store("plain.adm", inputs, "--coding", "none")
    zstd = {found["of"]: found for found in lines_of(bench.build, "bench_series_pages", coded_file)}
    yield from file_rows(series.name, coded, plain, zstd, "<= 0.54" if series.aim else "")
    yield one_by_one_row(bench, inputs, coded)
    plays = {steps: (bench.play(coded_file, steps), bench.play(plain_file, steps)) for steps in READ_STEPS}
    for steps, both in plays.items():
        yield reading_row(series, steps, SAMPLE_BYTES[coded["type"]], *both)
    least = bench.play(coded_file, 1)
    yield needs_row(series.name, least, lines_of(bench.build, "bench_series_bytes", coded_file, str(series.isovalue))[0])
    timed = bench.timed(coded_file)
    yield time_row(series, *zip(*timed))
    draw_plays(bench, plays, timed[-1][1])


def series_rows(build, quick):
    for series in all_series(quick):
        if not series.inputs:
            note(f"bench: {series.name} is not there: no rows for it")
            continue
        with folder_of(series) as folder:
            bench = Bench(build, folder, series)
            yield from rows_of(bench)
            if series.inputs != ["mixing.pvd"]:
                continue
            found = lines_of(build, "bench_series_coefficients", bench.path("coded.adm"))[0]
            draw_coefficients(bench, found)
            yield from coefficient_table(series.name, found)
            yield from gradient_rows(bench, bench.generate())
            if os.path.exists(os.path.join(build, "tests/benchmarks/bench_interpolation")):
                steps = int(series.generate[series.generate.index("--steps") + 1])
                yield from interpolation_rows(build, series.name, bench.path("coded.adm"), series.isovalue, steps, os.cpu_count())
    large = large_series(quick)
    with folder_of(large) as folder:
        bench = Bench(build, folder, large)
        file, _ = bench.store("coded.adm", bench.generate())
        for error in (ERROR, FINE_ERROR):
            yield time_row(large, *zip(*bench.timed(file, error)), error)
