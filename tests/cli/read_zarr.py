#!/usr/bin/env python3
"""Reads .zarr folders that `restore` writes by the formats' descriptions alone (Zarr 2, NGFF 0.4), and by zarr.

usage: read_zarr.py ADAMAS

Makes small volumes and series, stores them, restores them as .zarr, and compares the samples of every level and
step with those that `restore` writes as .raw. Exits with 77 where all is well but zarr is not installed."""

import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77
TYPES = {"uint8": ("|u1", "B"), "uint16": ("<u2", "H"), "int16": ("<i2", "h"), "float32": ("<f4", "f")}


def load(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return json.load(file)


def chunk_bytes(folder, header, place):
    """The samples of a chunk, which is as large at the edges as elsewhere."""
    with open(os.path.join(folder, *map(str, place)), "rb") as file:
        samples = zlib.decompress(file.read())
    width = int(header["dtype"][2])
    assert len(samples) == math.prod(header["chunks"]) * width, place
    return samples


def read_array(folder):
    """The header, and the bytes of the whole array; every file in the folder is a chunk that is asked for."""
    header = load(folder, ".zarray")
    assert header["zarr_format"] == 2 and header["order"] == "C" and header["dimension_separator"] == "/"
    assert header["compressor"]["id"] == "zlib" and header["filters"] is None and header["fill_value"] == 0
    shape, chunks, width = header["shape"], header["chunks"], int(header["dtype"][2])
    nz, ny, nx = shape[-3:]
    cz, cy, cx = chunks[-3:]
    counts = [-(-n // c) for n, c in zip(shape, chunks)]
    files = sum(len(names) for _, _, names in os.walk(folder)) - 1
    assert files == math.prod(counts), f"{folder}: {files} chunks"
    steps = []
    for step in range(shape[0] if len(shape) == 4 else 1):
        whole = bytearray(nz * ny * nx * width)
        for z, y, x in ((z, y, x) for z in range(counts[-3]) for y in range(counts[-2]) for x in range(counts[-1])):
            samples = chunk_bytes(folder, header, ([step] if len(shape) == 4 else []) + [z, y, x])
            length = min(cx, nx - x * cx) * width
            for k in range(min(cz, nz - z * cz)):
                for j in range(min(cy, ny - y * cy)):
                    at = (((z * cz + k) * ny + y * cy + j) * nx + x * cx) * width
                    start = (k * cy + j) * cx * width
                    whole[at:at + length] = samples[start:start + length]
        steps.append(bytes(whole))
    return header, steps


class Program:
    def __init__(self, adamas, folder):
        self.adamas, self.folder = adamas, folder

    def __call__(self, *arguments):
        subprocess.run([self.adamas, *arguments, "--quiet"], cwd=self.folder, check=True)

    def raw(self, store, level, step, more):
        self("restore", store, "--level", str(level), "--step", str(step), *more, "-o", "level.raw")
        with open(os.path.join(self.folder, "level.raw"), "rb") as file:
            return file.read()


def samples_of(type_name, count, step):
    """Some that are smooth in part, so that pages are coded in time too."""
    noise = random.Random(step)
    code = TYPES[type_name][1]
    values = [(n // 7 + step * 3 + (noise.randrange(5) if n % 11 == 0 else 0)) % 251 for n in range(count)]
    if code == "f":
        values = [value / 3 for value in values]
    return struct.pack(f"<{count}{code}", *values)


def check(program, zarr, type_name, size, steps, first=0, level=0, more=()):
    """Stores such a series, and compares what .zarr has of it. Returns the number of levels."""
    names = []
    for step in range(steps):
        names.append(f"s_{step}.raw")
        with open(os.path.join(program.folder, names[-1]), "wb") as file:
            file.write(samples_of(type_name, math.prod(size), step))
    program("store", *names, "--dimensions", ",".join(map(str, size)), "--type", type_name, "--spacing", "0.5,1,2",
            "--first-sample", "3,4,5", "-o", "s.adm")
    options = ["--level", str(level), *more] + (["--steps", f"{first},{steps - 1}"] if steps > 1 else [])
    program("restore", "s.adm", *options, "-o", "s.ome.zarr", "--overwrite")
    folder = os.path.join(program.folder, "s.ome.zarr")
    assert load(folder, ".zgroup") == {"zarr_format": 2}
    scale = load(folder, ".zattrs")["multiscales"][0]
    assert scale["version"] == "0.4" and scale["name"] == "s"
    axes = [axis["name"] for axis in scale["axes"]]
    assert axes == (["t"] if steps > 1 else []) + ["z", "y", "x"]
    for lod, dataset in enumerate(scale["datasets"], level):
        header, found = read_array(os.path.join(folder, dataset["path"]))
        assert header["dtype"] == TYPES[type_name][0]
        kinds = [each["type"] for each in dataset["coordinateTransformations"]]
        assert kinds == ["scale", "translation"]
        spacing = dataset["coordinateTransformations"][0]["scale"]
        assert spacing[-3:] == [2.0 * 2**lod, 1.0 * 2**lod, 0.5 * 2**lod]
        place = dataset["coordinateTransformations"][1]["translation"]
        assert len(place) == len(axes)
        if not more:
            assert place[-3:] == [5, 4, 3]
        for at, samples in enumerate(found):
            assert samples == program.raw("s.adm", lod, first + at, more), f"level {lod}, step {first + at}"
            if zarr is not None:
                array = zarr.open_group(folder, mode="r")[dataset["path"]]
                assert (array[at] if steps > 1 else array[:]).tobytes() == samples, f"zarr: level {lod}, step {at}"
    last = scale["datasets"][-1]["path"]
    assert max(load(folder, last, ".zarray")["shape"][-3:]) <= 64
    return len(scale["datasets"])


def check_reading(program, zarr):
    """Stores what zarr writes with each of its compressors, and compares the samples."""
    import numcodecs
    import numpy

    values = (numpy.arange(9 * 21 * 34, dtype="<u2") * 7).reshape(9, 21, 34)
    for codec in (numcodecs.Blosc(), numcodecs.Zstd(), numcodecs.GZip(), numcodecs.Zlib(), None):
        name = f"in_{codec.codec_id if codec else 'raw'}"
        group = zarr.open_group(os.path.join(program.folder, name + ".zarr"), mode="w")
        group.create_dataset("0", data=values, chunks=(4, 8, 16), compressor=codec)
        group.attrs["multiscales"] = [{"version": "0.4", "axes": [{"name": each} for each in "zyx"],
                                       "datasets": [{"path": "0", "coordinateTransformations": [
                                           {"type": "scale", "scale": [2, 1, 0.5]}]}]}]
        program("store", name + ".zarr", "-o", name + ".adm")
        assert program.raw(name + ".adm", 0, 0, ()) == values.tobytes(), name


def main():
    try:
        import zarr
    except ImportError:
        zarr = None
    with tempfile.TemporaryDirectory() as folder:
        program = Program(sys.argv[1], folder)
        assert check(program, zarr, "uint8", (131, 70, 65), 1) == 3
        assert check(program, zarr, "uint16", (70, 20, 5), 11) == 2
        assert check(program, zarr, "int16", (64, 3, 1), 3) == 1
        assert check(program, zarr, "float32", (90, 33, 9), 10, first=3) == 2
        assert check(program, zarr, "float32", (140, 20, 20), 2, level=1) == 2
        assert check(program, zarr, "uint8", (140, 20, 20), 9, more=("--region", "10,70,4,12,9,40"), first=7) == 2
        # A single plane with an odd number has samples of one level only.
        assert check(program, zarr, "uint8", (20, 20, 140), 1, more=("--region", "3,4,4,12,5,283")) == 3
        if zarr is not None:
            check_reading(program, zarr)
    if zarr is None:
        print("skipped: zarr (python3-zarr) is not installed; the chunks were read without it")
        sys.exit(SKIPPED)


if __name__ == "__main__":
    main()
