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


def drop_span(data, _, rng):
    start, end = _span(data, rng)
    return data[:start] + data[end:]


def repeat_span(data, _, rng):
    start, end = _span(data, rng)
    return data[:end] + data[start:end] * int(rng.integers(1, 40)) + data[end:]


def insert_noise(data, _, rng):
    start, _ = _span(data, rng)
    return data[:start] + rng.bytes(int(rng.integers(1, 100))) + data[start:]


def blank_span(data, _, rng):
    start, end = _span(data, rng)
    return data[:start] + bytes([int(rng.integers(256))]) * (end - start) + data[end:]


def splice(data, other, rng):
    return data[: int(rng.integers(len(data) + 1))] + other[int(rng.integers(len(other) + 1)) :]


def odd_number(data, _, rng):
    numbers = list(NUMBER.finditer(data))
    if not numbers:
        return data
    match = pick(numbers, rng)
    return data[: match.start()] + pick(ODD_NUMBERS, rng) + data[match.end() :]


def odd_word(data, _, rng):
    start, _ = _span(data, rng)
    return data[:start] + pick(WORDS, rng) + data[start:]


def shuffle_lines(data, _, rng):
    lines = data.split(b"\n")
    a, b = rng.integers(len(lines), size=2)
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def drop_line(data, _, rng):
    lines = data.split(b"\n")
    del lines[int(rng.integers(len(lines)))]
    return b"\n".join(lines)


def indent_line(data, _, rng):
    lines = data.split(b"\n")
    place = int(rng.integers(len(lines)))
    lines[place] = b" " * int(rng.integers(1, 9)) + lines[place]
    return b"\n".join(lines)


def nest(data, _, rng):
    return data + b"\n" + b"[" * int(rng.integers(1, 3000))


def odd_float(data, _, rng):
    facet, place = int(rng.integers(_facets(data))), int(rng.integers(12))
    value = struct.pack("<f", pick(ODD_FLOATS, rng))
    start = HEADER + facet * FACET + 4 * place
    return data[:start] + value + data[start + 4 :]


def odd_count(data, _, rng):
    count = int(rng.choice([0, 1, _facets(data) - 1, _facets(data) + 1, 2**31, 2**32 - 1]))
    return data[:80] + struct.pack("<I", count) + data[HEADER:]


def drop_facet(data, _, rng):
    start = HEADER + int(rng.integers(_facets(data))) * FACET
    return _counted(data[:start] + data[start + FACET :])


def repeat_facet(data, _, rng):
    start = HEADER + int(rng.integers(_facets(data))) * FACET
    return _counted(data + data[start : start + FACET] * int(rng.integers(1, 50)))


def turn_facet(data, _, rng):
    start = HEADER + int(rng.integers(_facets(data))) * FACET
    a, b = data[start + 12 : start + 24], data[start + 24 : start + 36]
    return data[: start + 12] + b + a + data[start + 36 :]


def scale(data, _, rng):
    return _moved(data, np.multiply, float(rng.choice([1e-30, 1e-12, 1e-6, 1e6, 1e12, 1e30, -1.0, 0.0])))


def shift(data, _, rng):
    return _moved(data, np.add, rng.choice([1e3, 1e6, 1e9, 1e20]))


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


BYTES = (flip_bits, cut_short, drop_span, repeat_span, insert_noise, blank_span, splice)
LINES = (odd_number, odd_number, odd_word, odd_word, shuffle_lines, drop_line, indent_line, nest)
FACETS = (odd_float, odd_count, drop_facet, repeat_facet, turn_facet, scale, shift, flatten, jitter)
