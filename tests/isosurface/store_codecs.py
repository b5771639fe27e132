"""The bits, tables and codecs of a store's samples, as docs/stored_pages.md tells of them."""
import struct


class Bytes:
    """Takes numbers from the front of bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        self.at += count
        assert self.at <= len(self.data)
        return self.data[self.at - count:self.at]

    def number(self, form):
        return struct.unpack("<" + form, self.take(struct.calcsize(form)))[0]

    def varint(self):
        value, shift = 0, 0
        while True:
            byte = self.take(1)[0]
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    def sized(self):
        return self.take(self.varint())

    def rest(self):
        return self.take(len(self.data) - self.at)


class Bits:
    """Takes bits from the front of bytes."""

    def __init__(self, data):
        self.number, self.taken = int.from_bytes(data, "little"), 0

    def take(self, count):
        value = self.number >> self.taken & (1 << count) - 1
        self.taken += count
        return value

    def gamma(self):
        zeros = 0
        while self.take(1) == 0:
            zeros += 1
        return 1 << zeros | self.take(zeros)

    def delta(self):
        bits = self.gamma() - 1
        return 1 << bits | self.take(bits)


def width(x):
    return x.bit_length()


class Contexts:
    """Tables of contexts: by context a list of the symbol, its first number and its frequency, by number."""

    def __init__(self, bits, contexts, symbols):
        self.symbols, self.of_context = symbols, []
        tables = []
        for _ in range(contexts):
            table = bits.take(width(len(tables)))
            if table == len(tables):
                tables.append(self.read_table(bits))
            self.of_context.append(tables[table])

    def read_table(self, bits):
        def frequency():
            w = bits.take(4)
            return 0 if w == 0 else 1 << w - 1 | bits.take(w - 1)

        escape = frequency()
        found, total = {}, escape
        symbol = 0
        while total < 1024:
            f = frequency()
            if f == 0:
                symbol += bits.gamma()
                continue
            found[symbol] = f
            total += f
            symbol += 1
        slots = []
        for symbol in sorted(found) + [None]:
            f = escape if symbol is None else found[symbol]
            begin = len(slots)
            slots += [(symbol, begin, f)] * f
        assert len(slots) == 1024
        return slots


class States:
    """A sequence of symbols that is coded by so many states, and the plain bits in it."""

    def __init__(self, contexts, data, count):
        self.contexts, self.data, self.end = contexts, data, len(data)
        self.bits = Bits(data)
        self.states = []
        for _ in range(count):
            n = 10 + self.bits.take(4)
            self.states.append(1 << n | self.bits.take(n))
        self.next = 0

    def group(self, contexts):
        symbols = []
        for context in contexts:
            x = self.states[self.next]
            symbol, begin, f = self.contexts.of_context[context][x % 1024]
            x = f * (x // 1024) + x % 1024 - begin
            if x < 1024:
                self.end -= 2
                x = x << 16 | int.from_bytes(self.data[self.end:self.end + 2], "little")
            self.states[self.next] = x
            self.next = (self.next + 1) % len(self.states)
            symbols.append(symbol)
        escaped = width(self.contexts.symbols - 1)
        return [self.bits.take(escaped) if symbol is None else symbol for symbol in symbols]

    def check_end(self):
        """The bytes that were carried along."""
        assert all(1024 <= x < 2048 for x in self.states) and (self.bits.taken + 7) // 8 == self.end
        states = self.states[self.next:] + self.states[:self.next]
        bits = sum((x - 1024) << 10 * n for n, x in enumerate(states))
        return bits.to_bytes(10 * len(states) // 8, "little")


def z_order(q):
    return sum((q[axis] >> t & 1) << 3 * t + axis for axis in range(3) for t in range(4))


def step_of(q):
    """The greatest power of 2, up to 16, that divides all coordinates."""
    return next(z for z in (16, 8, 4, 2, 1) if all(x % z == 0 for x in q))


def cube():
    return [(i, j, k) for k in range(16) for j in range(16) for i in range(16)]


ALL_IN_Z_ORDER = sorted(cube(), key=lambda q: (-step_of(q), z_order(q)))


class Page:
    """What is known of a page before it is decoded."""

    def __init__(self, count, complete, around):
        self.count, self.complete, self.around = count, complete, around

    def inside(self, q):
        return all(0 <= q[axis] < self.count[axis] for axis in range(3))

    def own(self):
        return [q for q in ALL_IN_Z_ORDER if self.inside(q) and (self.complete or any(x & 1 for x in q))]

    def mean(self, q, words):
        """The mean of the ends of the split edge."""
        if self.complete and q == (0, 0, 0):
            return 0
        z = step_of(q)
        ends = [[], []]
        for axis in range(3):
            d = {0: 0, 1: z, 2: 0, 3: -z}[q[axis] // z % 4]
            a, b = q[axis] - d, q[axis] + d
            if self.complete and q[axis] + abs(d) >= self.count[axis]:
                a = b = q[axis] - abs(d)
            ends[0].append(a)
            ends[1].append(b)
        a, b = (words[tuple(e)] if self.complete else self.around[tuple(e)] for e in ends)
        return (a + b) // 2


class Lead:
    """Coding 0."""

    def __init__(self, tables, bits):
        self.bits, self.codes = bits, []
        stream = Bits(tables)
        for _ in range(bits + 1):
            count = stream.take(width(bits + 1))
            lengths = [stream.take(4) for _ in range(count)]
            word, before, code = -1, 0, {}
            for length, symbol in sorted((n, s) for s, n in enumerate(lengths) if n > 0):
                word = (word + 1) << length - before
                before = length
                code[length, word] = symbol
            self.codes.append(code)

    def decode(self, kind, data, page):
        stream, previous, words = Bits(data), 0, {}
        for q in page.own():
            r = 0
            if kind == 2:
                length, word = 0, 0
                while (length, word) not in self.codes[previous]:
                    word, length = word << 1 | stream.take(1), length + 1
                previous = symbol = self.codes[previous][length, word]
                if symbol == self.bits:
                    r = -(1 << symbol - 1)
                elif symbol > 0:
                    sign = stream.take(1)
                    r = 1 << symbol - 1 | stream.take(symbol - 1)
                    r = -r if sign else r
            words[q] = (page.mean(q, words) + r) % (1 << self.bits)
        return words


def plus(q, axis, step):
    return tuple(x + step if a == axis else x for a, x in enumerate(q))


class Interpolation:
    """Coding 1, with values of so many bits."""

    def __init__(self, tables, bits, value_bits, centre=0, greatest=None):
        self.bits, self.value_bits, self.centre = bits, value_bits, centre
        self.greatest = (1 << bits) - 1 if greatest is None else greatest
        stream = Bits(tables)
        self.prevailing = stream.take(8) if bits == 8 and stream.take(1) else None
        self.of_class = 37 if value_bits == 32 else 1 + 2 * (value_bits + 4)
        self.of_set = self.of_class * (1 if self.prevailing is None else 6)
        symbols = 16 + 4 * (bits - 4) + (self.prevailing is not None)
        self.contexts = Contexts(stream, 3 * self.of_set + 1, symbols)

    def context(self, activity, prediction):
        if self.prevailing is not None:
            distance = abs(prediction + self.centre - self.prevailing)
            return min(width(distance), 5) * self.of_class + self.context_of_activity(activity)
        return self.context_of_activity(activity)

    def context_of_activity(self, activity):
        w = width(activity)
        if self.value_bits == 32 or w == 0:
            return w
        return 2 * w - 1 + (activity >> w - 2 & 1 if w > 1 else 0)

    def edge(self, v, q, axis):
        p0, p1, p2, p3 = (v[plus(q, axis, step)] for step in (-1, 1, -3, 3))
        ends = [plus(q, axis, step) for step in (-1, 1)]
        prediction = (9 * (p0 + p1) - p2 - p3 + 8) // 16
        prediction = min(max(prediction, -self.centre), self.greatest - self.centre)
        activity = None
        if all(0 <= x < 16 for x in q):
            activity = 2 * abs(p0 - p1) + abs(p0 - p2) + abs(p1 - p3) + sum(
                abs(v[end] - v[plus(end, a, step)]) for end in ends for a in range(3) for step in (-2, 2))
        return prediction, activity

    def face(self, v, r, q, a, b):
        edges = [plus(q, axis, step) for axis in (a, b) for step in (-1, 1)]
        e = [v[p] for p in edges]
        c = [v[plus(plus(q, a, s), b, t)] for s in (-1, 1) for t in (-1, 1)]
        prediction = (5 * sum(e) - sum(c) + 8) // 16
        prediction = min(max(prediction, min(e + c)), max(e + c))
        errors = sum(r.get(p, 0) for p in edges)
        return prediction, 2 * (max(e) - min(e) + errors) + max(c) - min(c)

    def centre_of(self, v, r, q):
        faces = [plus(q, axis, step) for axis in range(3) for step in (-1, 1)]
        f = [v[p] for p in faces]
        near = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
        total = {n: sum(v[tuple(x + y for x, y in zip(q, d))] for d in near if sum(map(abs, d)) == n) for n in (2, 3)}
        prediction = (8 * sum(f) - 2 * total[2] + total[3] + 16) // 32
        prediction = min(max(prediction, min(f)), max(f))
        return prediction, 2 * (max(f) - min(f) + sum(r.get(p, 0) for p in faces))

    def residuals(self, states, contexts):
        """None where the sample is the prevailing one."""
        folded = states.group(contexts)
        for n, symbol in enumerate(folded):
            if symbol == 32 and self.prevailing is not None:
                folded[n] = None
            elif symbol >= 16:
                left = (symbol - 16) // 4 + 2
                folded[n] = (4 | symbol & 3) << left | states.bits.take(left)
        return [None if u is None else u // 2 if u % 2 == 0 else -(u + 1) // 2 for u in folded]

    def decode(self, kind, data, page):
        states = States(self.contexts, data, 16) if kind == 2 else None
        words = {}
        if page.complete:
            own = page.own()
            found = self.residuals(states, [3 * self.of_set] * len(own)) if states else [0] * len(own)
            for q, r in zip(own, found):
                words[q] = (page.mean(q, words) + r) % (1 << self.bits)
        else:
            words = self.decode_sets(states, page)
        self.along = states.check_end() if states else b""
        return words

    def decode_sets(self, states, page):
        v = {q: word - self.centre for q, word in page.around.items()}
        magnitudes, words = {}, {}
        for number, odds in enumerate((((0,), (1,), (2,)), ((0, 1), (0, 2), (1, 2)), ((0, 1, 2),))):
            own, contexts, predictions = [], [], {}
            for odd in odds:
                axes = [range(1, 16, 2) if axis in odd else range(0, 18, 2) for axis in range(3)]
                for q in ((i, j, k) for k in axes[2] for j in axes[1] for i in axes[0]):
                    if number == 0:
                        prediction, activity = self.edge(v, q, *odd)
                    elif number == 1:
                        prediction, activity = self.face(v, magnitudes, q, *odd)
                    else:
                        prediction, activity = self.centre_of(v, magnitudes, q)
                    predictions[q] = prediction
                    if page.inside(q):
                        own.append(q)
                        contexts.append(number * self.of_set + self.context(activity, prediction))
            found = self.residuals(states, contexts) if states else [0] * len(own)
            v.update(predictions)
            for q, r in zip(own, found):
                if r is None:
                    r = (self.prevailing - predictions[q] - self.centre + 128) % 256 - 128
                    assert r != 0
                words[q] = (predictions[q] + self.centre + r) % (1 << self.bits)
                v[q] = words[q] - self.centre
                magnitudes[q] = abs(r)
        return words


class Ranks:
    """Coding 2."""

    def __init__(self, tables, bits):
        stream = Bytes(tables)
        values = Bits(stream.sized())
        count = values.take(16) + 1
        self.values, before = [], -1
        for _ in range(count):
            before += values.delta()
            self.values.append(before)
        self.rank = {value: rank for rank, value in enumerate(self.values)}
        if count <= 256:
            self.codec = Interpolation(stream.rest(), 8, 8)
        elif count <= 4095:
            self.codec = Interpolation(stream.rest(), 16, 12, 2047, 4094)
        else:
            self.codec = Interpolation(stream.rest(), 16, 16)

    def decode(self, kind, data, page):
        if kind == 0:
            size = self.codec.bits // 8
            return {q: self.values[int.from_bytes(data[size * n:size * n + size], "little")] for n, q in enumerate(page.own())}
        around = {q: self.rank.get(word, 0) for q, word in page.around.items()}
        ranks = self.codec.decode(kind, data, Page(page.count, page.complete, around))
        self.along = self.codec.along
        return {q: self.values[rank] for q, rank in ranks.items()}


def codec_of(coding, tables, bits):
    if coding == 0:
        return Lead(tables, bits)
    if coding == 1:
        return Interpolation(tables, bits, bits)
    return Ranks(tables, bits)
