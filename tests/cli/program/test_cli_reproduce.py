"""``feeder reproduce``: the thesis's tables and figures in one call."""

import csv
import json
import re

import pytest
from click.testing import CliRunner

from feederscrew_cli.main import feeder

KEYS = ["id", "kind", "caption", "cells", "exact", "explained", "differs", "given", "findings", "files"]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder of one whole run, and its JSON."""
    root = tmp_path_factory.mktemp("reproduce")
    result = CliRunner().invoke(feeder, ["reproduce", "-o", str(root), "--format", "json"])
    assert result.exit_code == 0, result.output
    return root / "thesis", json.loads(result.stdout)


def rows(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_the_contract(written):
    _, document = written
    assert all(list(item) == KEYS for item in document["items"])
    keys = [(item["kind"], item["id"]) for item in document["items"]]
    assert len(set(keys)) == 28
    assert ("table", "3-13") in keys and ("figure", "5-7") in keys
    assert all(item["differs"] == 0 for item in document["items"])
    assert all(item["findings"] for item in document["items"] if item["explained"])


def test_every_file_named_is_there_and_nothing_else(written):
    folder, document = written
    named = {name for item in document["items"] for name in item["files"]}
    others = {"thesis.md", "thesis.html", "summary.csv", "findings.csv", "run.json"}
    assert {path.name for path in folder.iterdir()} == named | others


def test_a_table_file_sets_print_beside_ours(written):
    folder, _ = written
    cells = rows(folder / "table_3_09.csv")
    assert list(cells[0]) == [
        "row", "column", "published", "recomputed", "deviation", "verdict", "explaining", "finding",
    ]  # fmt: skip
    assert len(cells) == 36
    for cell in cells:
        assert cell["verdict"] == "exact to print"
        assert abs(float(cell["recomputed"]) - float(cell["published"])) < 6e-6


def test_the_page_is_self_contained(written):
    folder, _ = written
    text = (folder / "thesis.html").read_text()
    assert text.count("data:image/png;base64,") == 15
    assert not re.search(r"https?:", text)


def test_stdout_is_a_summary(run):
    result = run("reproduce")
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    assert lines[0].split() == ["item", "cells", "exact", "explained", "differs", "given", "findings"]
    named = {line.split("  ")[0].strip() for line in lines[1:]}
    assert len(lines) == 1 + 28 + 5 + 8  # tables and figures, lost drawings, conclusions
    assert {"figure 3-1", "figure 3-5", "conclusion 1", "conclusion 8"} <= named
    assert result.stderr == ""
