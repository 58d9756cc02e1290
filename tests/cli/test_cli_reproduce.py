"""``feeder reproduce``: the thesis's tables and figures in one call."""

import json
import re

from command_lines import called, names, rows

KEYS = ["id", "kind", "caption", "cells", "exact", "explained", "differs", "given", "findings", "files"]
CELLS = ["row", "column", "published", "recomputed", "deviation", "verdict", "explaining", "finding"]


def test_one_call_writes_every_table_and_figure(tmp_path):
    """One whole run: its contract, its files, Table 3-9 to print, a page that needs no other file."""
    document = json.loads(called("reproduce", "-o", tmp_path, "--format", "json").stdout)
    items = document["items"]
    # Chapter 6.2, with the effect of products of inertia on the T: by hand, D alone leans.
    advice = document["recommendations"]
    assert [each["number"] for each in advice] == [1, 2, 3, 4] and all(each["lacks"] for each in advice)
    assert "0.31 percentage points" in advice[2]["met"] and "p_pmi_principal" in advice[2]["met"]
    assert "Chapter 6.2" in (tmp_path / "thesis/thesis.md").read_text()
    assert all(list(item) == KEYS and item["differs"] == 0 for item in items)
    assert all(item["findings"] for item in items if item["explained"])
    keys = {(item["kind"], item["id"]) for item in items}
    assert len(keys) == 28 == len(items) and {("table", "3-13"), ("figure", "5-7")} <= keys
    folder = tmp_path / "thesis"
    others = {"thesis.md", "thesis.html", "summary.csv", "findings.csv", "run.json"}
    assert names(folder) == {name for item in items for name in item["files"]} | others
    cells = rows(folder / "table_3_09.csv")
    assert list(cells[0]) == CELLS and len(cells) == 36
    for cell in cells:
        assert cell["verdict"] == "exact to print"
        assert abs(float(cell["recomputed"]) - float(cell["published"])) < 6e-6
    page = (folder / "thesis.html").read_text()
    assert page.count("data:image/png;base64,") == 15 and not re.search(r"https?:", page)
    # stdout is a summary
    result = called("reproduce")
    head, *lines = result.stdout.splitlines()
    assert head.split() == ["item", "cells", "exact", "explained", "differs", "given", "findings"]
    items = {line.split("  ")[0].strip() for line in lines}
    assert len(lines) == 28 + 5 + 8 + 4  # tables and figures, lost drawings, conclusions, recommendations
    assert {"figure 3-1", "figure 3-5", "conclusion 1", "conclusion 8", "recommendation 4"} <= items
    assert result.stderr == ""
