"""Damaged files: every way we have seen one arrive, and chance."""

import re
import struct

import numpy as np

NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
ODD_NUMBERS = (
    b"nan", b"inf", b"-inf", b"0", b"-0.0", b"1e308", b"-1e308", b"1e-320", b"1e999", b"9" * 400, b"0x1F",
    b"1_000", b"0,5", b"1.2.3", b"", b"-1", b"1e", b"\xd9\xa3",
)  # fmt: skip
ODD_FLOATS = (np.nan, np.inf, -np.inf, 0.0, -0.0, 3.4e38, -3.4e38, 1e-45, 1e-30, 1e30, 1.0)
WORDS = (
    b"&a", b"*a", b"!!python/object:os.system", b"{", b"}", b"[", b"]", b'"', b"'", b":", b"- ", b"\t", b"#",
    b"|", b">", b"%YAML 9", b"---", b"...", b"? ", b"null", b"yes", b"<<: *a", b"\xef\xbb\xbf", b"\x00",
    b"\xff\xfe", b"\xe2\x80\xae", b"mm", b"deg", b"kg/m3", b"=1+1", b",", b";", b"\r\n", b"\r", b"A" * 5000,
)  # fmt: skip
HEADER, FACET = 84, 50  # [bytes] of a binary STL
BLIND = 0.25  # share of damage that knows nothing of the format
LONGEST = 1_000_000  # [bytes]


def mutated(data, other, rng):
    """A seed file damaged once or a few times; never longer than ``LONGEST``."""
    for _ in range(int(rng.geometric(0.6))):
        kinds = BYTES if rng.random() < BLIND else FACETS if _is_binary_stl(data) else LINES
        data = pick(kinds, rng)(data, other, rng)[:LONGEST]
    return data


def pick(choices, rng):
    """One of some choices."""
    return choices[int(rng.integers(len(choices)))]


def _is_binary_stl(data):
    return len(data) > HEADER and (len(data) - HEADER) % FACET == 0 and not data.startswith(b"solid")


def _span(data, rng, most=200):
    start = int(rng.integers(len(data) + 1))
    return start, min(len(data), start + int(rng.integers(1, most)))


def flip_bits(data, _, rng):
    out = bytearray(data)
    for place in rng.integers(max(len(out), 1), size=int(rng.integers(1, 9))) if out else ():
        out[place] ^= 1 << int(rng.integers(8))
    return bytes(out)


def cut_short(data, _, rng):
    return data[: int(rng.integers(len(data) + 1))]


def of_span(change):
    """Damage of a stretch of bytes, of which ``change`` makes others."""

    def damaged(data, _, rng):
        start, end = _span(data, rng)
        return data[:start] + change(data[start:end], rng) + data[end:]

    return damaged


def odd_number(data, _, rng):
    numbers = list(NUMBER.finditer(data))
    if not numbers:
        return data
    match = pick(numbers, rng)
    return data[: match.start()] + pick(ODD_NUMBERS, rng) + data[match.end() :]


def shuffle_lines(data, _, rng):
    lines = data.split(b"\n")
    a, b = rng.integers(len(lines), size=2)
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def of_line(change):
    """Damage of one line, of which ``change`` makes some."""

    def damaged(data, _, rng):
        lines = data.split(b"\n")
        place = int(rng.integers(len(lines)))
        lines[place : place + 1] = change(lines[place], rng)
        return b"\n".join(lines)

    return damaged


def of_facet(change):
    """Damage of one facet, in place or taken out."""

    def damaged(data, _, rng):
        start = HEADER + int(rng.integers(_facets(data))) * FACET
        out = data[:start] + change(data[start : start + FACET], rng) + data[start + FACET :]
        return out if len(out) == len(data) else _counted(out)

    return damaged


def odd_float(facet, rng):
    start = 4 * int(rng.integers(12))
    return facet[:start] + struct.pack("<f", pick(ODD_FLOATS, rng)) + facet[start + 4 :]


def odd_count(data, _, rng):
    count = int(rng.choice([0, 1, _facets(data) - 1, _facets(data) + 1, 2**31, 2**32 - 1]))
    return data[:80] + struct.pack("<I", count) + data[HEADER:]


def repeat_facet(data, _, rng):
    start = HEADER + int(rng.integers(_facets(data))) * FACET
    return _counted(data + data[start : start + FACET] * int(rng.integers(1, 50)))


def flatten(data, _, rng):
    factors = np.ones(3)
    factors[int(rng.integers(3))] = float(rng.choice([0.0, 1e-9, 1e-6, 1e-3, -1.0]))
    return _moved(data, np.multiply, factors)


def jitter(data, _, rng):
    size = float(rng.choice([1e-6, 1e-4, 1e-2, 1.0]))
    return _moved(data, lambda corners, size: corners + rng.normal(0.0, size, corners.shape), size)


def _facets(data):
    return (len(data) - HEADER) // FACET


def _counted(data):
    return data[:80] + struct.pack("<I", _facets(data)) + data[HEADER:]


def _moved(data, move, by):
    dtype = np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    rows = np.frombuffer(data[HEADER:], dtype).copy()
    with np.errstate(all="ignore"):
        rows["c"] = move(rows["c"].astype(float), by)
    return data[:HEADER] + rows.tobytes()


BYTES = (
    flip_bits,
    cut_short,
    of_span(lambda span, rng: b""),
    of_span(lambda span, rng: span * (1 + int(rng.integers(1, 40)))),
    of_span(lambda span, rng: rng.bytes(int(rng.integers(1, 100))) + span),
    of_span(lambda span, rng: bytes([int(rng.integers(256))]) * len(span)),
    lambda data, other, rng: cut_short(data, other, rng) + other[int(rng.integers(len(other) + 1)) :],
)
odd_word = of_span(lambda span, rng: pick(WORDS, rng) + span)
LINES = (
    *(odd_number, odd_number, odd_word, odd_word, shuffle_lines),
    of_line(lambda line, rng: []),
    of_line(lambda line, rng: [b" " * int(rng.integers(1, 9)) + line]),
    lambda data, _, rng: data + b"\n" + b"[" * int(rng.integers(1, 3000)),  # nested
)
SIZES = [1e-30, 1e-12, 1e-6, 1e6, 1e12, 1e30, -1.0, 0.0]
FACETS = (
    *(of_facet(odd_float), odd_count, of_facet(lambda facet, rng: b""), repeat_facet),
    of_facet(lambda facet, rng: facet[:12] + facet[24:36] + facet[12:24] + facet[36:]),  # turned
    lambda data, _, rng: _moved(data, np.multiply, float(rng.choice(SIZES))),
    lambda data, _, rng: _moved(data, np.add, rng.choice([1e3, 1e6, 1e9, 1e20])),
    *(flatten, jitter),
)
