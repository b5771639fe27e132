"""Rows of scripts/bench on volumes: storing, coding, contouring, from disk to a surface, and very large ones."""

import json
import lzma
import math
import os
import re
import subprocess
import sys
import tempfile

MEBI = 2**20
# Of the files that say nothing of themselves: the form that bench_volume_codec takes.
RAW_FORMS = {"invesalius_cranium/matrix.dat": "raw:256,256,108,int16,0:", "tuwien_dat/lobster": "raw:120,120,34,uint16,6:",
             "tuwien_dat/": "raw:138,138,82,uint16,6:", "pvm/Bucky_32x32x32_uint8.raw": "raw:32,32,32,uint8,0:"}
NO_VOLUMES = re.compile(r"\.(md|plist|json|txt\.md)$|copyright|LICEN", re.IGNORECASE)


def note(text):
    print(text, file=sys.stderr, flush=True)


def lines_of(build, program, *arguments):
    """What a program prints, a line of JSON for each row."""
    note(f"bench: {program} " + " ".join(arguments))
    path = os.path.join(build, "tests/benchmarks", program)
    result = subprocess.run([path, *arguments], stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"bench: {program} ended with {result.returncode}")
    return [json.loads(line) for line in result.stdout.splitlines()]


def run_measured(*command):
    """Ends where the command fails. Returns processor seconds and peak memory in bytes."""
    note("bench: " + " ".join(os.path.basename(command[0]) if i == 0 else a for i, a in enumerate(command)))
    child = subprocess.Popen(command)  # wait4 tells of this one alone
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"bench: {command[0]} ended with {child.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def million(count):
    return f"{count / 1e6:.3g} M/s"


def bytes_text(count):
    return f"{count / MEBI:.0f} MiB"


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def make_buckyball(build, folder, side):
    """The header's path; the samples alone lie beside it, as .raw."""
    path = os.path.join(folder, f"ball{side}.nhdr")
    run_measured(os.path.join(build, "cli/adamas"), "generate", "buckyball", "--dimensions", str(side), "-q", "-o", path)
    return path


def store(build, data, path, *options):
    """What `adamas store` says of itself, with processor seconds."""
    figures = path + ".json"
    seconds, _ = run_measured(os.path.join(build, "cli/adamas"), "store", data, *options, "-q", "--json", figures, "-o", path)
    with open(figures, encoding="utf-8") as file:
        return json.load(file) | {"processor_seconds": seconds}


def store_rows(build, quick):
    for side in (256,) if quick else (256, 512):
        with tempfile.TemporaryDirectory() as folder:
            data = make_buckyball(build, folder, side)
            for threads in (2, 1):
                path = os.path.join(folder, f"{threads}.adm")
                found = store(build, data, path, "--threads", str(threads))
                at = f"buckyball {side}^3, {threads} threads" if threads > 1 else f"buckyball {side}^3, 1 thread"
                rate = found["samples"] / found["seconds"]
                ours = f"{million(rate)} ({million(found['samples'] / found['processor_seconds'])} of processor time)"
                yield ["store", ours, "8 M/s (aim)" if threads > 1 else "", f"{rate / 8e6:.2f}" if threads > 1 else "",
                       ">= 1" if threads > 1 else "", at]
                bound = 2**30 + 64 * side * side
                peak = found["peak_memory_bytes"]
                yield ["store: peak memory", bytes_text(peak), bytes_text(bound) + " (aim)", f"{peak / bound:.2f}", "<= 1", at]
            yield ["store: input / file", f"{found['ratio']:.2f}, samples {found['ratio_data']:.2f}", "", "", "",
                   f"buckyball {side}^3, errors and ranges in the file"]


def volume_form(path):
    for part, form in RAW_FORMS.items():
        if part in path:
            return form + path
    return path


def data_volumes():
    """All volumes of the published data that lie beside the project, as the program takes them."""
    root = os.path.join(os.environ.get("ADAMAS_DATA", "../shared/data"), "volume")
    if not os.path.isdir(root):
        note(f"bench: {root} is not there: no rows for its volumes")
    found = []
    for folder, folders, files in os.walk(root):
        folders.sort()
        slices = sorted(f for f in files if f.endswith(".tif"))
        if slices:
            start = os.path.commonprefix(slices).rstrip("0123456789")
            found.append(f"stack:{os.path.join(folder, start)}*.tif")
        found += [volume_form(os.path.join(folder, f)) for f in sorted(files) if f not in slices and not NO_VOLUMES.search(f)]
    return found


def can_read(build, volume):
    """Whether there is a volume in the file. What cannot be read is named."""
    path = os.path.join(build, "tests/benchmarks/bench_volume_codec")
    result = subprocess.run([path, "--look", volume], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        note(f"bench: left out: {result.stderr.strip()}")
    return result.returncode == 0


def codec_table(lines):
    """Rows of what bench_volume_codec prints."""
    volumes = {}
    for line in lines:
        volumes.setdefault(line["volume"], {})[line["coder"]] = line
    ours, peers = ("interpolation", "split edge"), ("JPEG-LS", "Lorenzo + zstd -19")

    def ratio(volume, coder):
        return volumes[volume][coder]["input"] / volumes[volume][coder]["bytes"]

    for name, of in volumes.items():
        line = of["interpolation"]
        size = "x".join(str(n) for n in line["dimensions"])
        theirs = ", ".join(f"{p} {ratio(name, p):.2f} at {million(of[p]['decode'])}" for p in peers)
        best = max(ratio(name, p) for p in peers)
        for coder in ours:
            yield [f"lossless, {name}: {coder}", f"{ratio(name, coder):.2f} at {million(of[coder]['decode'])}", theirs,
                   f"{ratio(name, coder) / best:.2f}", "", f"{size} {line['type']}, bytes of samples, directory and tables, 1 thread"]
    for coder in ours:
        mean = geometric_mean([ratio(v, coder) for v in volumes])
        for peer in peers:
            theirs = geometric_mean([ratio(v, peer) for v in volumes])
            yield [f"lossless, geometric mean: {coder}", f"{mean:.2f}", f"{peer} {theirs:.2f}", f"{mean / theirs:.2f}",
                   "> 1 (then 1.15)" if coder == ours[0] else "", f"{len(volumes)} volumes"]
    for coder in ours:
        for what, name in (("restore", "pages to values"), ("decode", "codec alone")):
            rates = [of[coder][what] for of in volumes.values()]
            first = next(iter(volumes))
            yield [f"decode, {coder}, {name}", f"{million(geometric_mean(rates))} (mean), {million(rates[0])} ({first})",
                   "300 M/s (aim)", f"{geometric_mean(rates) / 3e8:.2f}", ">= 1" if what == "restore" else "",
                   f"samples a second of processor time, {len(volumes)} volumes, 1 thread"]


def codec_rows(build, quick):
    sides = ["128"] if quick else ["256", "256:uint16"]
    volumes = [f"{name}:{side}" for name in ("buckyball", "turbulence") for side in sides]
    if not quick:
        volumes += [v for v in data_volumes() if can_read(build, v)]
    yield from codec_table([line for v in volumes for line in lines_of(build, "bench_volume_codec", v)])


def contour_table(lines):
    """Rows of what bench_contour prints."""
    for line in lines:
        if line["triangles"] != line["peer_triangles"]:
            sys.exit(f"bench: contour: expected {line['peer_triangles']} triangles, found {line['triangles']}")
        doing = ["shared points" if line["shared"] else "its points not shared"]
        doing += ["with its normals"] if line["normals"] else []
        yield [f"contour, {line['mesh']}", million(line["adamas"]),
               f"vtkContour3DLinearGrid {million(line['peer'])} ({', '.join(doing)})", f"{line['ratio']:.2f}",
               ">= 1.5" if line["shared"] and not line["normals"] else "",
               f"{line['tetrahedra']:,} tetrahedra, {line['triangles']:,} triangles, tetrahedra per processor second, 1 thread"]


def contour_rows(build, quick):
    yield from contour_table(lines_of(build, "bench_contour", *(["--quick"] if quick else [])))


def time_row(line):
    ours, peer = line["adamas"], line["peer"]
    name = f"disk to surface, {line['wanted']}, {'cold' if line['cold'] else 'warm'}"
    name += ", with normals" if line["normals"] else ""

    def cost(c):
        return f"{c['seconds']:.2f} s ({c['processor_seconds']:.2f} of processor)"

    at = f"{ours['triangles']:,} triangles of error {line['error']:.2f} against {peer['triangles']:,}, 1 thread"
    yield [name, cost(ours), f"raw + Flying Edges {cost(peer)}", f"{ours['seconds'] / peer['seconds']:.2f} ({ours['processor_seconds'] / peer['processor_seconds']:.2f})",
           "<= 0.25" if line["normals"] else "", at]
    yield [name + ": memory", bytes_text(ours["peak_bytes"]), bytes_text(peer["peak_bytes"]),
           f"{ours['peak_bytes'] / peer['peak_bytes']:.2f}", "<= 0.1" if line["normals"] else "", at]


def surface_table(lines):
    """Rows of what bench_disk_to_surface prints."""
    for line in lines:
        if line["row"] == "time":
            yield from time_row(line)
        elif line["row"] == "coarse":
            peer = line["peer"]
            yield ["disk to surface, Flying Edges, every 2nd sample", "",
                   f"{peer['seconds']:.2f} s, {bytes_text(peer['peak_bytes'])}", "", "",
                   f"{peer['triangles']:,} triangles, all samples read, warm, with normals"]
        else:
            yield [f"distance, {line['wanted']}",
                   f"greatest {line['to']:.3f} there, {line['from']:.3f} back",
                   f"99.9% within {line['to_999']:.3f} there, {line['from_999']:.3f} back", "", "",
                   f"{line['triangles']:,} triangles; voxels, from and to Flying Edges of all samples"]


def surface_rows(build, quick):
    side = 256 if quick else 512
    with tempfile.TemporaryDirectory() as folder:
        data = make_buckyball(build, folder, side)
        path = os.path.join(folder, "ball.adm")
        store(build, data, path)
        triangles = 500_000 if side == 512 else 125_000
        yield from surface_table(lines_of(build, "bench_disk_to_surface", path, data.replace(".nhdr", ".raw"), "80.5",
                                          str(triangles), "3" if quick else "5"))


# Measured volumes: a part of the path, the options that `adamas store` needs, and an isovalue.
MEASURED = [("thewildnath/StanfordHead/*.tif", ["--stack"], 700), ("vtkjs/bonsai.vti", [], 40), ("vtkjs/engine.vti", [], 100),
            ("vtkjs/aneurism.vti", [], 100), ("vtkjs/LIDC2.vti", [], 80), ("vtkjs/tooth.nrrd", [], 130),
            ("openscivis/heptane.nii.gz", [], 60), ("pyvista_misc/ironProt.vtk", [], 100),
            ("invesalius_cranium/matrix.dat", ["--dimensions", "256,256,108", "--type", "int16", "--spacing", "0.957,0.957,1.5"], 300),
            ("tuwien_dat/lobster_120x120x34.dat", ["--dimensions", "120,120,34", "--type", "uint16", "--header-bytes", "6"], 400)]
ADAMAS, PLAIN, EDGES = "adamas", "adamas, plain", "Flying Edges, stride "


def both_ways(line, which):
    """The mean of the distances there and back, for means; else the greater of them."""
    there, back = line["to"][which], line["from"][which]
    return (there + back) / 2 if which == 0 else max(there, back)


def quality_table(name, lines, ratios):
    """Rows of what bench_surface_quality prints of a volume. Adds to `ratios` those of mean and 99.9th percentile."""
    exact = lines[0]
    yield [f"surface of {name}, error 0", f"{exact['triangles']:,} triangles, {exact['seconds']:.2f} s",
           f"plain {lines[1]['triangles']:,} triangles, {lines[1]['seconds']:.2f} s", f"{exact['triangles'] / lines[1]['triangles']:.2f}",
           "", f"mean least angle {exact['angle']:.1f} for {lines[1]['angle']:.1f} degrees, below 10 degrees {exact['narrow']:.1%} for {lines[1]['narrow']:.1%}"]
    for n, edges in enumerate(lines):
        if not edges["surface"].startswith(EDGES):
            continue
        ours = lines[n + 1]
        if ours["surface"] != ADAMAS:
            sys.exit(f"bench: surface of {name}: expected one of adamas, found {ours['surface']}")
        at = f"{ours['triangles']:,} triangles, {ours['seconds']:.2f} s, {edges['surface']}; both ways, voxels"
        for which, what, aim in ((0, "mean distance", "<= 0.5"), (1, "99.9% within", "<= 0.5"), (2, "greatest distance", "")):
            ratio = both_ways(ours, which) / both_ways(edges, which)
            if aim:
                ratios.setdefault(what, []).append(ratio)
            yield [f"surface of {name}: {what}", f"{both_ways(ours, which):.3f}", f"Flying Edges {both_ways(edges, which):.3f}",
                   f"{ratio:.2f}", aim, at]
        for peer in lines[n + 2:n + 5]:
            if peer["surface"].startswith(EDGES) or peer["surface"] == ADAMAS:
                break
            yield [f"surface of {name}: {peer['surface']}", "", f"mean {both_ways(peer, 0):.3f}, 99.9% {both_ways(peer, 1):.3f}, {peer['seconds']:.2f} s",
                   f"{both_ways(ours, 0) / both_ways(peer, 0):.2f}" if both_ways(peer, 0) > 0 else "", "", f"{peer['triangles']:,} triangles"]


def compressed_by_others(raw):
    """Bytes of the samples by zstd -19 and by xz -6."""
    with open(raw, "rb") as file:
        xz = len(lzma.compress(file.read(), preset=6))
    zstd = len(subprocess.run(["zstd", "-19", "-q", "-c", raw], check=True, stdout=subprocess.PIPE).stdout)
    return {"zstd -19": zstd, "xz -6": xz}


def file_rows(name, raw, found):
    """The whole file beside the samples compressed by others."""
    others = compressed_by_others(raw)
    least = min(others, key=others.get)
    yield [f"file of {name}", f"{found['bytes_file']:,} bytes", ", ".join(f"{n} {b:,}" for n, b in others.items()),
           f"{found['bytes_file'] / others[least]:.3f}", "< 1",
           f"{found['bytes_data']:,} of samples, {found['bytes_errors']:,} of errors and ranges; {found['bytes_input']:,} given"]


def speed_rows(build, name, file, raw, isovalue):
    """From the store to the surface of all samples, and to one of 0.7 voxel, beside Flying Edges."""
    for line in lines_of(build, "bench_disk_to_surface", file, raw, str(isovalue), "0", "3"):
        for n, row in enumerate(time_row(line)):
            aim = {"error 0": "<= 1.5", "error 0.7 voxel": "<= 0.25"}.get(line["wanted"], "") if n == 0 else "< 1"
            yield [f"{name}: {row[0]}", *row[1:4], aim, row[5]]


def quality_rows(build, quick):
    root, ratios = os.path.join(os.environ.get("ADAMAS_DATA", "../shared/data"), "volume"), {}
    for path, options, isovalue in MEASURED[:2] if quick else MEASURED:
        with tempfile.TemporaryDirectory() as folder:
            data, file = os.path.join(root, path), os.path.join(folder, "volume.adm")
            if "*" not in data and not os.path.exists(data):
                note(f"bench: {data} is not there: no rows for it")
                continue
            found, raw, name = store(build, data, file, *options), os.path.join(folder, "volume.raw"), os.path.basename(path)
            run_measured(os.path.join(build, "cli/adamas"), "restore", file, "-o", raw, "--quiet")
            lines = lines_of(build, "bench_surface_quality", file, str(isovalue), "2", "4", "--decimate")
            yield from quality_table(name, lines, ratios)
            yield from file_rows(name, raw, found)
            yield from speed_rows(build, name, file, raw, isovalue)
    for what, of in ratios.items():
        yield [f"surfaces: {what}, geometric mean", "", "", f"{geometric_mean(of):.2f}, at most {max(of):.2f}", "<= 0.5", f"{len(of)} surfaces"]


def volume_rows(build, quick):
    for part in (quality_rows, codec_rows, store_rows, contour_rows, surface_rows):
        yield from part(build, quick)
