"""The sources of the site, read as its build reads them: fences, links, files, notebooks. None is built."""

import importlib.util
import json
import re

import pytest
from command_lines import ROOT

DOCS = ROOT / "docs"
SPEC = importlib.util.spec_from_file_location("site_texts", DOCS / "site/texts.py")
texts = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(texts)
PAGES = {path.relative_to(DOCS).as_posix(): path.read_text() for path in sorted(DOCS.rglob("*.md"))}
PAGES["overview.md"] = (ROOT / "README.md").read_text().replace("](docs/", "](")
BOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
PLAIN = re.compile(r"```\w*")  # the only opening that pymdownx.superfences takes: it has no options here


@pytest.mark.parametrize("place", PAGES)
def test_a_page_has_fences_that_the_site_prints_as_code(place):
    """Fourteen opened with `console sampled`: they were printed as prose, and what followed was inverted."""
    marks = [
        line for line in texts.plain_fences(PAGES[place]).splitlines() if line.lstrip().startswith("```")
    ]
    assert [line for line in marks if not PLAIN.fullmatch(line.strip())] == []
    assert len(marks) % 2 == 0 and all(line.strip() == "```" for line in marks[1::2])
    prose = "".join(texts.FENCE.split(texts.plain_fences(PAGES[place]))[::2])
    assert "```" not in prose


def test_the_word_behind_a_language_is_taken_off_and_nothing_else():
    page = "a\n```console sampled\n$ b ```c\n```\n\n```sh\nd\n```\n"
    assert texts.plain_fences(page) == page.replace(" sampled", "")


def test_a_link_leads_to_a_page_a_file_to_take_or_is_words():
    there = {"bowl.md", "method/bowl.md", "notebooks/a_drive.md"}.__contains__
    assert texts.link_of("bowl.md", "tooling.md", there) == "bowl.md"
    assert texts.link_of("../bowl.md", "method/trial.md", there) == "../bowl.md"
    assert texts.link_of("conveying_map.csv", "conveying.md", there) == "files/docs/conveying_map.csv"
    assert texts.link_of("../counts.csv", "method/trial.md", there) == "../files/docs/counts.csv"
    assert texts.link_of("../parts/washer_m6.stl", "counts.md", there) == "files/parts/washer_m6.stl"
    assert texts.link_of("notebooks/a_drive.ipynb", "gallery.md", there) == "notebooks/a_drive.md"
    assert texts.link_of("../README.md", "counts.md", there) == "overview.md"
    for gone in ("nowhere.md", "nowhere.csv", "../../etc/passwd.csv", "../feederscrew"):
        assert texts.link_of(gone, "counts.md", there) is None


def test_a_page_lists_every_part_bowl_file_and_script_that_it_uses():
    assert {"docs/tutorial/countersunk_m4x12.stl", "docs/tutorial/parts.py"} <= set(
        texts.named_files(PAGES["tutorial.md"], "tutorial.md")
    )
    assert "parts/lbracket_30x20x15.stl" in texts.named_files(PAGES["gallery.md"], "gallery.md")
    assert "docs/conveying_map.csv" in texts.named_files(PAGES["conveying.md"], "conveying.md")
    for place, text in PAGES.items():
        named = texts.named_files(text, place)
        used = re.findall(r"(?<![\w/.-])((?:parts|configs)/\w+\.(?:stl|step|yaml|csv))\b", text)
        assert {name for name in used if (ROOT / name).exists()} <= set(named), place
        assert all(path.is_relative_to(ROOT) and path.is_file() for path in named.values())


@pytest.mark.parametrize("path", BOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_outputs_and_its_code_compiles(path):
    """Its build runs it: `make site`."""
    cells = json.loads(path.read_text())["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert len(code) >= 5 and cells[0]["source"][0].startswith("# ")
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells)
    for cell in code:
        compile(cell, path.name, "exec")


def test_there_are_three_notebooks_and_the_gallery_leads_to_them():
    assert len(BOOKS) >= 3
    assert all(f"](notebooks/{path.name})" in PAGES["gallery.md"] for path in BOOKS)
