"""The pages against the program: every page is reached, every name on them is there, every example runs."""

import contextlib
import importlib
import io
import re
import subprocess
import sys
from pathlib import Path

import pytest
from command_lines import ROOT
from test_layers import DOORS, ORDER

LOOKED_AT = True  # the library page shows the size of a picture
DOCS = ROOT / "docs"
PAGES = sorted([ROOT / "README.md", *DOCS.rglob("*.md")])
TEXTS = {page: page.read_text() for page in PAGES}
ARCHITECTURE = TEXTS[DOCS / "architecture.md"]
LINK = re.compile(r"\]\(([^)#\s]+)(?:#([^)\s]+))?\)")
EXAMPLE = re.compile(r"```python\n(.*?)```\n(?:\n```\n(.*?)```)?", re.DOTALL)
CODE = re.compile(r"```.*?```", re.DOTALL)
MEASURED = re.compile(
    r"as\s+measured|measured\s+(?:sets?|toss|cuboid|column)|(?:was|were)\s+measured", re.IGNORECASE
)


def program(*call):
    done = subprocess.run([sys.executable, *call], capture_output=True, text=True, cwd=ROOT)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.thorough
def test_the_examples_of_the_library_page_print_what_it_shows(monkeypatch):
    monkeypatch.chdir(ROOT)
    names, examples = {"__name__": "library"}, EXAMPLE.findall(TEXTS[DOCS / "library.md"])
    assert len(examples) >= 5
    for code, shown in examples:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "docs/library.md", "exec"), names)
        assert printed.getvalue() == shown


@pytest.mark.parametrize(
    "name", ["commands", "equations", "rules", "bowl_file", "columns", "validation", "designs"]
)
def test_a_generated_page_is_as_the_program_is(name):
    assert program(f"docs/{name}.py", "--check") == (0, "", ""), f"run: python docs/{name}.py"


def test_the_readme_is_short_and_the_index_leads_to_every_page():
    """The pages of docs/method/ are reached from a page whose evidence they hold."""
    assert len(TEXTS[ROOT / "README.md"].splitlines()) <= 260
    reached, ways = set(), [DOCS / "README.md"]  # by the links of the index, and of the pages it leads to
    while ways:
        page = ways.pop()
        reached.add(page)
        there = {(page.parent / link).resolve() for link, _ in LINK.findall(TEXTS[page])}
        ways += [other for other in there & set(TEXTS) if other not in reached and other.parent == DOCS]
    assert [page.name for page in DOCS.glob("*.md") if page not in reached] == []
    index = TEXTS[DOCS / "README.md"]
    for role in ("designer", "researcher", "maintainer", "developer"):
        assert f"]({role}.md)" in index
    pages = "".join(text for page, text in TEXTS.items() if page.parent == DOCS)
    assert [page.name for page in DOCS.glob("method/*.md") if f"](method/{page.name}" not in pages] == []


def anchors(page):
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_of_a_page_leads_somewhere_and_its_tables_keep_their_lines(page):
    """Text that was wrapped anew must not take a table into its lines; no page names a registry's host."""
    text = TEXTS[page]
    for target, anchor in LINK.findall(text):
        path = page.parent / target
        assert "://" in target or path.exists(), target
        assert "://" in target or not anchor or anchor in anchors(path), f"{target}#{anchor}"
    rules = [line.strip() for line in text.splitlines() if "|---" in line or "|:--" in line]
    assert [line for line in rules if not re.fullmatch(r"\|(?:\s*:?-+:?\s*\|)+", line)] == []
    assert not re.search(r"https?://[^\s)>\]]*(npm|pypi|debian)", text)


def test_what_says_that_it_was_measured_leads_to_the_sets_and_each_set_is_on_their_page():
    """In each section of a page; code blocks speak of the reader's own measurements."""
    silent, count = [], 0
    for page, text in TEXTS.items():
        if (
            page.name in ("validation.md", "commands.md", "bowl_file.md", "columns.md")
            or page.parent.name == "method"
        ):
            continue
        for section in re.split(r"^(?=## )", text, flags=re.MULTILINE):
            if MEASURED.search(CODE.sub("", section)):
                count += 1
                silent += [] if "validation.md" in section else [(page.name, section.split("\n")[0])]
    assert count > 5 and silent == []
    stems = {path.stem for path in (DOCS / "measured").rglob("*.csv") if "example" not in path.parts}
    titles = {"arc_chute": "## Arc Chute", "magnet": "## Magnet"}
    page = TEXTS[DOCS / "validation.md"]
    assert [stem for stem in sorted(stems) if titles.get(stem, stem) not in page] == []


def sentences(text):
    """The sentences of a page's paragraphs and lists: no headings, tables, code or targets of links."""
    text = re.sub(r"<!--.*?-->", "\n\n", CODE.sub("\n\n", text), flags=re.DOTALL)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    text = re.sub(r"^\s*(?:\|.*|#.*)$", "", text, flags=re.MULTILINE)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        yield from re.split(r"(?<=[.!?:])\s+(?=[A-Z`*\[(\d])", " ".join(block.split()))


def test_no_sentence_of_the_pages_is_longer_than_thirty_words():
    texts = [text for page, text in TEXTS.items() if page.name != "commands.md"]
    every = [sentence for text in texts for sentence in sentences(text)]
    assert [sentence for sentence in every if len(re.findall(r"\S*\w\S*", sentence)) > 30] == []  # 265 once


def rows(heading):
    """Cells of each row of the first table below a heading of the architecture page."""
    below = ARCHITECTURE.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in below.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_stages_and_doors_are_those_of_the_layers_in_their_order():
    assert [name for cells in rows("Stages") for name in re.findall(r"`([\w.]+)`", cells[0])] == ORDER
    for libraries, door in rows("One door a library"):
        for library in libraries.split(", "):
            places = [place.removeprefix("feederscrew/") for place in DOORS[library]]
            for stage in re.findall(r"`(\w+)`", door):
                assert any(place.startswith(stage) for place in places), (library, places)


def test_the_functions_folders_and_modules_that_the_pages_name_are_there():
    dotted_names = re.findall(r"`(feederscrew(?:\.\w+)+)`", ARCHITECTURE)
    for dotted in dotted_names:
        module, _, name = dotted.rpartition(".")
        assert callable(getattr(importlib.import_module(module), name))
    folders = re.findall(r"`((?:\w+/)+)`", ARCHITECTURE)
    modules = {path for text in TEXTS.values() for path in re.findall(r"`([\w/]+/\w+\.py)`", text)}
    assert len(dotted_names) >= 4 and len(folders) >= 6 and len(modules) > 10
    for path in (*folders, *modules):
        assert (ROOT / path).exists() or (ROOT / "feederscrew" / path).exists(), path


def test_a_release_knows_its_version_and_its_changes():
    version = re.search(r'__version__ = "(.*)"', (ROOT / "feederscrew/base/version.py").read_text())[1]
    assert re.search(r"^## (\S+?),", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1] == version
    _, said, fault = program("docs/release.py")
    assert f"git tag v{version}" in said and not fault


def test_every_picture_of_the_pages_is_made_by_make_docs_and_shown():
    """One was made and never shown: the page spoke of 'the picture above'."""
    made = re.search(r"^PICTURES := (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[1].split()
    assert sorted(made) == sorted(path.stem for path in DOCS.glob("*.png"))
    shown = {target for text in TEXTS.values() for target in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text)}
    pictures = {path.name for path in DOCS.iterdir() if path.suffix in (".png", ".gif")}
    assert {Path(target).name for target in shown} == pictures
