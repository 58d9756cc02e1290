"""The pages that lead through the project: every page is reached, every name on them is there."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from test_layers import DOORS, ORDER

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted([ROOT / "README.md", *DOCS.rglob("*.md")])
LINK = re.compile(r"\]\(([^)#\s]+)(?:#([^)\s]+))?\)")
MEASURED = re.compile(
    r"as\s+measured|measured\s+(?:sets?|toss|cuboid|column)|(?:was|were)\s+measured", re.IGNORECASE
)
ARCHITECTURE = (DOCS / "architecture.md").read_text()


def rows(heading):
    """Cells of each row of the first table below a heading of the architecture page."""
    below = ARCHITECTURE.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in below.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 260


def test_the_index_leads_to_every_page():
    """The pages of docs/method/ are reached from a page whose evidence they hold."""
    index = (DOCS / "README.md").read_text()
    assert [page.name for page in DOCS.glob("*.md") if f"]({page.name})" not in index] == ["README.md"]
    pages = "".join(page.read_text() for page in DOCS.glob("*.md"))
    assert [page.name for page in DOCS.glob("method/*.md") if f"](method/{page.name}" not in pages] == []


def anchors(page):
    """The headings of a page as links name them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_of_a_page_leads_somewhere(page):
    for target, anchor in LINK.findall(page.read_text()):
        if "://" in target:
            continue
        path = page.parent / target
        assert path.exists(), f"{page.name} leads to {target}"
        assert not anchor or anchor in anchors(path), f"{page.name} leads to {target}#{anchor}"


def test_what_says_that_it_was_measured_leads_to_the_sets():
    """In each section of a page; code blocks speak of the reader's own measurements."""
    silent, found = [], 0
    for page in PAGES:
        if page.name in ("validation.md", "commands.md", "bowl_file.md") or page.parent.name == "method":
            continue
        for section in re.split(r"^(?=## )", page.read_text(), flags=re.MULTILINE):
            if MEASURED.search(re.sub(r"```.*?```", "", section, flags=re.DOTALL)):
                found += 1
                silent += [] if "validation.md" in section else [(page.name, section.split("\n")[0])]
    assert found > 5 and silent == []


def test_every_measured_set_is_on_the_page_of_validation():
    text = (DOCS / "validation.md").read_text()
    stems = {path.stem for path in (DOCS / "measured").rglob("*.csv") if "example" not in path.parts}
    titles = {"arc_chute": "## Arc Chute", "magnet": "## Magnet"}
    assert [stem for stem in sorted(stems) if titles.get(stem, stem) not in text] == []


def sentences(page):
    """The sentences of a page's paragraphs and lists: no headings, tables, code or targets of links."""
    text = re.sub(r"```.*?```|<!--.*?-->", "\n\n", page.read_text(), flags=re.DOTALL)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    text = re.sub(r"^\s*(?:\|.*|#.*)$", "", text, flags=re.MULTILINE)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        yield from re.split(r"(?<=[.!?:])\s+(?=[A-Z`*\[(\d])", " ".join(block.split()))


def test_no_sentence_of_the_pages_is_longer_than_thirty_words():
    pages = [page for page in PAGES if page.name != "commands.md"]
    long = [one for page in pages for one in sentences(page) if len(re.findall(r"\S*\w\S*", one)) > 30]
    assert long == []  # 265 once


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_rows_of_a_table_stand_on_lines_of_their_own(page):
    """Text that was wrapped anew must not take a table into its lines."""
    rules = [line.strip() for line in page.read_text().splitlines() if "|---" in line or "|:--" in line]
    assert [line for line in rules if not re.fullmatch(r"\|(?:\s*:?-+:?\s*\|)+", line)] == []


def test_no_page_names_the_host_of_a_package_registry():
    for page in [*PAGES, *(ROOT / "feederscrew").rglob("*.md")]:
        assert not re.search(r"https?://[^\s)>\]]*(npm|pypi|debian)", page.read_text()), page


def test_the_rooms_are_those_of_the_layers_in_their_order():
    assert [name for cells in rows("Rooms") for name in re.findall(r"`([\w.]+)`", cells[0])] == ORDER


def test_the_doors_are_those_of_the_layers():
    for libraries, door in rows("One door a library"):
        for library in libraries.split(", "):
            held = DOORS[library]
            for room in re.findall(r"`(\w+)`", door):
                there = [place for place in held if place.removeprefix("feederscrew/").startswith(room)]
                assert there, (library, held)


def test_the_functions_on_the_way_of_a_part_are_there():
    named = re.findall(r"`(feederscrew(?:\.\w+)+)`", ARCHITECTURE)
    assert len(named) >= 4
    for dotted in named:
        module, _, name = dotted.rpartition(".")
        assert callable(getattr(importlib.import_module(module), name))


def test_the_folders_on_the_page_are_there():
    named = re.findall(r"`((?:\w+/)+)`", ARCHITECTURE)
    assert len(named) >= 6
    for folder in named:
        assert folder == "feederscrew/" or any(
            (root / folder).is_dir() for root in (ROOT, ROOT / "feederscrew")
        )


def test_a_release_knows_its_version_and_its_changes():
    text = (ROOT / "CHANGELOG.md").read_text()
    version = re.search(r'__version__ = "(.*)"', (ROOT / "feederscrew/version.py").read_text())[1]
    assert re.search(r"^## (\S+?),", text, re.MULTILINE)[1] == version
    said = subprocess.run([sys.executable, "docs/release.py"], cwd=ROOT, capture_output=True, text=True)
    assert f"git tag v{version}" in said.stdout and not said.stderr


def test_every_picture_of_the_pages_is_made_by_make_docs():
    made = re.search(r"^PICTURES := (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[1].split()
    assert sorted(made) == sorted(path.stem for path in DOCS.glob("*.png"))


def test_every_picture_is_shown_on_a_page():
    """One was made and never shown: the page spoke of 'the picture above'."""
    shown = {target for page in PAGES for target in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", page.read_text())}
    assert {Path(target).name for target in shown} == {
        path.name for path in DOCS.iterdir() if path.suffix in (".png", ".gif")
    }
