#!/usr/bin/env python3
"""Reads the samples and numbers of stores by docs/file_formats.md and docs/stored_pages.md alone, to see that they say all that is needed.

usage: read_store.py ADAMAS

Makes small volumes, stores each with the program ADAMAS in every coding, and compares the samples that are
decoded here with those of the volume.
"""
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

from store_codecs import Bytes, Page, codec_of, width


FORMS = "bBhHiIqQfd"  # of the types of numbers


class Store:
    """A store, of which words of samples can be read."""

    def __init__(self, data):
        self.data = data
        prologue = Bytes(data)
        assert prologue.take(8) == b"adamas\r\n" and prologue.number("I") == 7
        root_offset, root_size = prologue.number("Q"), prologue.number("Q")
        root = Bytes(data[root_offset:root_offset + root_size])
        self.bytes = (1, 2, 2, 4)[root.number("B")]
        self.size = [root.number("Q") for _ in range(3)]
        root.take(8 * 15)
        for _ in range(3):  # space and units
            root.sized()
        root.take(2 * 8)
        self.numbers = FORMS[root.number("B")]
        self.array = root.sized().decode()
        self.coding = root.number("B")
        root.take(1 + 4)
        steps = root.varint()
        root.take(8 * steps + 32)
        tables = [root.sized() for _ in range(4)]
        root.varint(), root.varint()
        self.codec = codec_of(self.coding, tables[0], 8 * self.bytes)
        self.last = [n - 1 for n in self.size]
        self.depth = width(max(max(self.last) - 1, 0))
        self.top = max(self.depth, 3) - 3
        self.pages = {}
        for _ in range(root.varint()):
            first, offset, size, at, _ = (root.varint() for _ in range(5))
            root.take(4)
            self.read_chunk(Bytes(data[offset:offset + size]), first, at)
        self.remainders = self.read_remainders(root) if self.numbers in "iIqQd" else []

    def read_remainders(self, root):
        """Those of all numbers, as whole numbers modulo 2^bits."""
        bits = 8 * struct.calcsize(self.numbers)
        plane = self.size[0] * self.size[1]
        planes = max(1, 2 ** 20 // plane)
        at, remainders = root.varint(), []
        for first in range(0, self.size[2], planes):
            count = plane * min(planes, self.size[2] - first)
            size = root.varint()
            if size == 0:
                remainders += [0] * count
                continue
            root.take(4)
            record = Bytes(self.data[at:at + size])
            at += size
            for begin in range(0, count, 1024):
                run = min(1024, count - begin)
                bits_each = record.number("B")
                packed = int.from_bytes(record.take((bits_each * run + 7) // 8), "little")
                for n in range(run):
                    folded = packed >> bits_each * n & (1 << bits_each) - 1
                    remainders.append((folded >> 1 ^ -(folded & 1)) % 2 ** bits)
            assert record.at == size
        return remainders

    def exact(self, words):
        """The numbers of samples, as their bytes."""
        size = struct.calcsize(self.numbers)
        numbers = [word_of_nearest(word, self.numbers) for word in words]
        bits = 8 * size
        if self.remainders:
            numbers = [(n + r) % 2 ** bits for n, r in zip(numbers, self.remainders)]
        if self.numbers == "d":
            numbers = [n ^ 1 << 63 if n >> 63 else n ^ 2 ** 64 - 1 for n in numbers]
        return b"".join(n.to_bytes(size, "little") for n in numbers)

    def extent(self, level):
        if level == self.top and self.depth > 0:
            step = 1 << self.depth - 1
            return [(m + step - 1) // step * step >> level for m in self.last]
        return [(m + (1 << level) - 1) >> level for m in self.last]

    def block(self, number):
        steps = (width(number) - 1) // 3
        z = number - (1 << 3 * steps)
        return self.top - steps, tuple(sum((z >> 3 * t + axis & 1) << t for t in range(20)) for axis in range(3))

    def read_chunk(self, chunk, first, at):
        plain = 0
        for number in range(max(first, 1), first + 512):
            level, block = self.block(number)
            if level < 0:
                break
            count = [e - 16 * b + 1 for e, b in zip(self.extent(level), block)]
            if min(count) < 1 or (level < self.top and max(count) == 1):
                continue
            if plain == 0 and (size := chunk.varint()) == 0:
                plain = chunk.varint()
                assert plain > 0
                chunk.take(2 * self.bytes)
            if plain > 0:
                plain -= 1
                self.pages[level, block] = b"\x01\x01\x01\x04"
                continue
            chunk.take(4)
            low, high = (int.from_bytes(chunk.take(self.bytes), "little") for _ in range(2))
            error = chunk.take(1)[0]
            if error > 0 and high > low:
                s = 0
                while (high - low - 1 >> s) + 1 > 16:
                    s += 1
                chunk.take(((high - low - 1 >> s) + 2) // 2)
            self.pages[level, block] = self.data[at:at + size]
            at += size
        assert plain == 0 and chunk.at == len(chunk.data)

    def samples(self):
        """The words of all levels, by coordinates in samples; those of the finest have all."""
        known = {}
        for (level, block), payload in sorted(self.pages.items(), reverse=True):
            extent = self.extent(level)
            count = [min(e - 16 * b + 1, 16) for e, b in zip(extent, block)]
            around = {}
            if level < self.top:
                coarser = self.extent(level + 1)
                for q in ((i, j, k) for k in range(-2, 20, 2) for j in range(-2, 20, 2) for i in range(-2, 20, 2)):
                    p = [min(max(8 * b + x // 2, 0), e) << level + 1 for b, x, e in zip(block, q, coarser)]
                    around[q] = known[tuple(p)]
            page = Page(count, level == self.top, around)
            stream = Bytes(payload)
            part = Bytes(stream.sized())
            kind = part.number("B")
            if kind == 3 or kind == 0 and self.coding != 2:
                words = {q: int.from_bytes(part.take(self.bytes), "little") for q in page.own()}
            else:
                words = self.codec.decode(kind, part.rest(), page)
            along = self.codec.along if kind == 2 and self.coding != 0 else b""
            size = stream.varint()
            carried = min(len(along), size)
            bounds = along[:carried] + stream.take(size - carried)
            assert not any(along[carried:]) and bounds[0] >> 2 <= 4
            for q, word in words.items():
                known[tuple((16 * b + x) << level for b, x in zip(block, q))] = word
        i, j, k = self.size
        return [known[x, y, z] for z in range(k) for y in range(j) for x in range(i)]


def word_of_nearest(word, form):
    """The number that is nearest to a sample, of which there is a word; float64 as a number in the order of values."""
    if form == "b":
        return word - 32768 & 255
    sample = struct.unpack("<f", (word ^ 2 ** 31 if word >> 31 else word ^ 2 ** 32 - 1).to_bytes(4, "little"))[0]
    if form == "d":
        bits = struct.unpack("<Q", struct.pack("<d", sample))[0]
        return bits ^ 2 ** 64 - 1 if bits >> 63 else bits ^ 2 ** 63
    bits = 8 * struct.calcsize(form)
    low, high = (0, 2 ** bits - 1) if form.isupper() else (-2 ** (bits - 1), 2 ** (bits - 1) - 1)
    return min(max(round(sample), low), high) % 2 ** bits


def ordered(sample, form):
    """A sample as a word."""
    if form == "h":
        return sample + 32768
    if form != "f":
        return sample
    bits = struct.unpack("<I", struct.pack("<f", sample))[0]
    return bits ^ 0xffffffff if bits >> 31 else bits ^ 0x80000000


def volumes():
    """Name, type, size and samples: smooth and noisy ones, few and many values, sides of all kinds."""
    rng = random.Random(3)

    def field(size, f):
        return [f(x, y, z) for z in range(size[2]) for y in range(size[1]) for x in range(size[0])]

    def wave(x, y, z):
        return math.sin(x / 5.1) * math.cos(y / 3.7 + z / 9) + math.sin(z / 4)

    for size in ((37, 18, 21), (17, 1, 33), (9, 9, 9), (1, 1, 1)):
        yield "uint8", "B", size, field(size, lambda *p: int(120 + 55 * wave(*p)))
        yield "uint8", "B", size, field(size, lambda *p: rng.randrange(256))
        yield "int16", "h", size, field(size, lambda *p: int(9000 * wave(*p)) + rng.randrange(40))
        yield "uint16", "H", size, field(size, lambda *p: 100 * int(20 + 9 * wave(*p)))
        yield "float32", "f", size, field(size, lambda *p: struct.unpack("f", struct.pack("f", wave(*p)))[0])
    size = (34, 18, 20)
    yield "uint8", "B", size, field(size, lambda *p: max(0, int(60 * wave(*p)) + rng.randrange(9) - 40))
    yield "int16", "h", size, field(size, lambda *p: 9 * max(7, int(20 * wave(*p)) + rng.randrange(3)))
    yield "uint8", "B", (70, 20, 20), field((70, 20, 20), lambda x, y, z: 255 if x + y < 9 else 200)
    yield "uint16", "H", size, field(size, lambda *p: 7 * int(1000 + 280 * wave(*p)))
    yield "float32", "f", size, field(size, lambda *p: float(int(90 * wave(*p))))
    for values in (200, 1000):
        yield "uint16", "H", size, field(size, lambda *p: 7 * rng.randrange(values))


def numbers():
    """Name, type, size and numbers of types that samples do not have."""
    rng = random.Random(4)
    size = (23, 17, 20)
    count = size[0] * size[1] * size[2]
    yield "int8", "b", size, [rng.randrange(-128, 128) for _ in range(count)]
    yield "float64", "d", size, [rng.choice((math.sin(n / 100), n, -n * 1e-320)) for n in range(count)]
    for name, form, bits in (("int32", "i", 32), ("uint32", "I", 32), ("int64", "q", 64), ("uint64", "Q", 64)):
        low = 0 if form.isupper() else -2 ** (bits - 1)
        yield name, form, size, [low + (rng.randrange(2 ** bits) if n % 2 else n) for n in range(count)]


def main(adamas):
    codings = set()
    with tempfile.TemporaryDirectory() as folder:
        raw, store = os.path.join(folder, "volume.raw"), os.path.join(folder, "volume.adm")
        for name, form, size, samples in volumes():
            with open(raw, "wb") as file:
                file.write(struct.pack(f"<{len(samples)}{form}", *samples))
            for coding in ("split-edge", "interpolation", "none"):
                if os.path.exists(store):
                    os.remove(store)
                subprocess.run([adamas, "store", raw, "--dimensions", ",".join(map(str, size)), "--type", name,
                                "--coding", coding, "-q", "-o", store], check=True)
                with open(store, "rb") as file:
                    found = Store(file.read())
                codings.add(found.coding)
                if found.samples() != [ordered(sample, form) for sample in samples]:
                    sys.exit(f"{name} {size} {coding}: expected the samples of the volume, found others")
        for name, form, size, wanted in numbers():
            with open(raw, "wb") as file:
                file.write(struct.pack(f"<{len(wanted)}{form}", *wanted))
            os.remove(store)
            subprocess.run([adamas, "store", raw, "--dimensions", ",".join(map(str, size)), "--type", name, "-q",
                            "-o", store], check=True)
            with open(store, "rb") as file:
                found = Store(file.read())
            if found.exact(found.samples()) != struct.pack(f"<{len(wanted)}{form}", *wanted):
                sys.exit(f"{name} {size}: expected the numbers of the volume, found others")
    if codings != {0, 1, 2}:
        sys.exit(f"expected stores of all codings, found {sorted(codings)}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
