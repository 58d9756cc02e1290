"""YAML trees with their places, and what is said of texts that are no settings."""

import io
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.base import documents
from feederscrew.base.errors import ConfigError, Faults, FeederError


def test_every_word_keeps_its_place_and_its_text():
    root, faults = documents.load("drive:\n  amplitude: 0,5 mm\nlist: [yes, '1']\n", "b.yaml")
    assert not faults
    drive, items = root.entries
    amplitude = drive.value.find("amplitude")
    assert (amplitude.where, amplitude.value.where) == ("b.yaml:2:3", "b.yaml:2:14")
    assert amplitude.value.text == "0,5 mm"
    texts = [(item.text, item.where) for item in items.value.items]
    assert texts == [("yes", "b.yaml:3:8"), ("1", "b.yaml:3:13")]
    assert root.find("drave") is None
    # Hints.
    assert documents.hint("Amplitud", ["amplitude", "frequency"]) == "did you mean amplitude?"
    assert documents.hint("xyz", ["amplitude", "frequency"]) == "known are amplitude, frequency"


CHECK = " - check the colons, quotes and indentation here"
FAULTS = {  # of a text: one that hides the rest, or one beside which the rest is read
    "": "b.yaml: is empty - write at least one 'key: value' line",
    "# a comment\n": "b.yaml: is empty - write at least one 'key: value' line",
    "a: 1\nb: c: d\n": f"b.yaml:2:5: is not YAML (mapping values are not allowed here){CHECK}",
    "a:\n\tb: 1\n": r"b.yaml:2:1: is not YAML (found character '\t' that cannot start any token)" + CHECK,
    "a: 1\n---\nb: 2\n": "b.yaml:2:1: a second document begins - keep one document in a file",
    "[" * 50: "b.yaml:1:14: is nested deeper than 12 levels - write it flatter",
    b"a: 1\nb: \xff\n": "b.yaml:2: byte 0xff is not UTF-8 - save the file as UTF-8 text",
    "a: 1\nb: \x00\n": "b.yaml:2: has the character U+0000, which no text file needs - remove it",
    "x" * 200_001: "b.yaml: has more than 200 kB - name a YAML file of settings",
    "a: 1\nb: 2\na: 3\n": "b.yaml:3:1: key 'a' is already in line 1 - keep one of them",
    "a: &x 1\n": "b.yaml:1:4: anchor '&x' is not allowed - write the value alone",
    "a: *x\n": "b.yaml:1:4: alias '*x' is not allowed - write the value itself",
    "a: !!float 1\n": "b.yaml:1:4: tag 'tag:yaml.org,2002:float' is not allowed - write the value alone",
    "? [a]\n: 2\n": "b.yaml:1:3: a key is not plain text - write 'key: value'",
}


@pytest.mark.parametrize("text", FAULTS, ids=lambda text: repr(text[:12]))
def test_each_fault_of_a_text_is_a_line_with_its_place(text):
    try:
        _, faults = documents.load(text, "b.yaml")
    except ConfigError as fault:
        faults = [fault]
    assert [line for fault in faults for line in fault.lines] == [FAULTS[text]]


def test_files_that_cannot_be_read(tmp_path):
    missing = tmp_path / "no.yaml"
    for path, told in (
        (missing, "no such file - check the path"),
        ("a" * 300, "cannot be read (File name too long) - check the path and its permissions"),
        (tmp_path, "is a folder - name a YAML file in it"),
    ):
        with pytest.raises(ConfigError) as caught:
            documents.read(path)
        assert caught.value.lines == (f"{path}: {told}",)
    # A byte order mark is no text.
    file = tmp_path / "b.yaml"
    file.write_bytes(b"\xef\xbb\xbfa: 1\r\n")
    assert documents.read(file)[0].find("a").value.text == "1"


def test_faults_are_told_in_order_and_once_a_place():
    given = ("--set b", "f:10:1", "f:2:9", "f:2:10", "f:2:9", "--set a")
    faults = [ConfigError(where, "x", "y") for where in given]
    with pytest.raises(Faults) as caught:
        documents.raise_all(faults)
    places = [fault.where for fault in caught.value.faults]
    assert places == ["f:2:9", "f:2:10", "f:10:1", "--set b", "--set a"]
    documents.raise_all([])
    # Of very many the first are listed: a file of 30,000 wrong keys gave 30,000 lines.
    faults = [ConfigError(f"f:{k}:1", "is odd", "mend it") for k in range(1, 1001)]
    with pytest.raises(Faults) as caught:
        documents.raise_all(faults)
    lines = caught.value.lines
    assert len(lines) == documents.MAX_FAULTS + 1 and lines[0].startswith("f:1:1: is odd")
    assert "950 further faults" in lines[-1]


@given(st.text(st.sampled_from("ab:-?[]{},&*!|>'\"%@#<\n\t 1"), max_size=60))
@settings(max_examples=300, deadline=None)
def test_any_text_is_a_tree_or_faults_of_one_line(text):
    try:
        _, faults = documents.load(text, "b.yaml")
    except FeederError as error:
        faults = [error]
    assert all("\n" not in str(fault) for fault in faults)


@pytest.mark.parametrize("size", [0, 1, 10, 11, 12])
def test_a_file_is_read_up_to_one_byte_more_than_is_of_use(tmp_path, size):
    path, text = tmp_path / "x", b"0123456789ab"[:size]
    path.write_bytes(text)
    assert documents.content(path, 10, "a file") == text[:11]
    assert documents.upto(io.BytesIO(text), 10) == text[:11]


def test_a_stream_is_read_whole_in_pieces(monkeypatch):
    class Dripping(io.BytesIO):
        def read(self, size=-1):
            return super().read(min(size, 7))

    monkeypatch.setattr(documents, "READ_CHUNK_BYTES", 16)
    text = bytes(range(100))
    assert documents.upto(Dripping(text), 1000) == text
    assert documents.upto(Dripping(text), 50) == text[:51]


def test_a_small_file_takes_little_memory(tmp_path):
    """Not a buffer of the greatest size that would be read."""
    path = tmp_path / "x"
    path.write_bytes(b"solid" * 1000)
    tracemalloc.start()
    try:
        for read in (documents.content(path, 1 << 30, "a file"), documents.upto(io.BytesIO(b"x"), 1 << 30)):
            assert len(read) in (1, 5000)
        assert tracemalloc.get_traced_memory()[1] < 50e6
    finally:
        tracemalloc.stop()
