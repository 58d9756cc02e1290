"""The site of `make site` as a browser shows it: search, widths, dark, code to copy, formulas."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

SITE = Path(__file__).parents[2] / "site"
MISSING = not (SITE / "index.html").exists()
pytestmark = [pytest.mark.extra, pytest.mark.skipif(MISSING, reason="make site makes it")]
in_chromium = pytest.mark.needs("chromium")
DOCS = SITE.parent / "docs"
BUILT = sorted(SITE.rglob("*.html"))
CODE = re.compile(r"<(script|style|pre|code)\b.*?</\1>", re.DOTALL)
OURS = [page for page in BUILT if page.parent.name != "viewer"]  # with the head of the theme
PAGES = ("index", "validation", "commands", "method/trial")
FRAME = """<iframe src="{page}" style="border:0;width:{width}px;height:900px"></iframe>
<script>onload = () => {{ document.body.dataset.width =
  document.querySelector("iframe").contentDocument.documentElement.scrollWidth; }}</script>"""


def dom(address, tmp_path, *flags):
    call = [shutil.which("chromium"), "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", *flags]
    call += ["--allow-file-access-from-files", "--virtual-time-budget=8000", f"--user-data-dir={tmp_path}"]
    return subprocess.run([*call, address], capture_output=True, text=True, timeout=300).stdout


@in_chromium
def test_search_copied_code_dark_pages_and_formulas_need_no_server_and_no_other_host(tmp_path):
    page = dom(f"{(SITE / 'index.html').as_uri()}?q=throw%20number", tmp_path)
    assert int(re.search(r"(\d+) matching documents", page)[1]) > 3
    assert "glossary.html" in page.partition("md-search-result__list")[2]
    page = dom((SITE / "gallery.html").as_uri(), tmp_path)
    pictures = (DOCS / "gallery.md").read_text().count("savefig(")
    assert page.count("md-code__button") >= pictures <= page.count('src="gallery/')
    assert 'data-md-color-scheme="slate"' in page
    assert (SITE / "formulas.html").read_text().count("<math") > 10
    asked = re.compile(r'<(?:script|link|img)[^>]+(?:src|href)="https?://')
    assert not [page.name for page in SITE.rglob("*.html") if asked.search(page.read_text())]


@in_chromium
@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("name", PAGES)
def test_no_page_is_wider_than_the_window(tmp_path, name, width):
    """Tables and code scroll within themselves on a telephone."""
    (tmp_path / "frame.html").write_text(FRAME.format(page=(SITE / f"{name}.html").as_uri(), width=width))
    page = dom((tmp_path / "frame.html").as_uri(), tmp_path / "profile", f"--window-size={width + 100},1000")
    assert int(re.search(r'data-width="(\d+)"', page)[1]) <= width


def plain(text):
    """Words alone, as a heading has them in the source and on its page."""
    return re.sub(r"\W+", " ", re.sub(r"<[^>]+>|&\w+;|&#\w+;|`|\]\([^)]*\)", " ", text)).strip().lower()


def source_headings():
    for source in [*sorted(DOCS.rglob("*.md")), DOCS.parent / "README.md"]:
        place = source.relative_to(DOCS) if source.is_relative_to(DOCS) else Path("overview.md")
        page = SITE / ("index.html" if place.name == "README.md" else place.with_suffix(".html"))
        yield source, page, re.sub(r"^```.*?^```", "", source.read_text(), flags=re.DOTALL | re.MULTILINE)


def test_no_page_shows_the_marks_of_markdown():
    """Fences that opened with `console sampled` were prose, and what followed was inverted."""
    for page in OURS:
        text = page.read_text()
        assert "```" not in re.sub(r"<(script|style)\b.*?</\1>", "", text, flags=re.DOTALL), page
        prose = re.sub(r"<[^>]+>", "", CODE.sub("", text))
        assert not re.search(r"\]\(|\*\*\w|^#{1,4} |<!--", prose, re.MULTILINE), page


def test_every_heading_of_a_source_stands_on_its_page():
    for source, page, text in source_headings():
        shown = [plain(h) for h in re.findall(r"<h[1-4][^>]*>(.*?)</h[1-4]>", page.read_text(), re.DOTALL)]
        for heading in re.findall(r"^#{1,4} (.+)$", text, re.MULTILINE):
            assert any(plain(heading) in one for one in shown), (source, heading)


def test_no_link_of_a_page_is_dead():
    for page in BUILT:
        for link in re.findall(r'(?:href|src)="([^"#?]+)', page.read_text()):
            outside = ":" in link or link.startswith("/")
            assert outside or (page.parent / link).exists(), (page, link)


def test_what_a_page_uses_can_be_taken_from_it():
    page = (SITE / "tutorial.html").read_text()
    name = "files/docs/tutorial/countersunk_m4x12.stl"
    assert f'href="{name}"' in page and (SITE / name).read_bytes() == (DOCS.parent / name[6:]).read_bytes()
    for name in re.findall(r'savefig\("(\w+)\.png"', (DOCS / "gallery.md").read_text()):
        assert {f'href="gallery/{name}.{kind}"' for kind in ("py", "ipynb")} <= set(
            re.findall(r'href="gallery/[\w.]+"', (SITE / "gallery.html").read_text())
        )
        json.loads((SITE / f"gallery/{name}.ipynb").read_text())
    for path in (DOCS / "notebooks").glob("*.ipynb"):  # run by the build, with its outputs
        cells = json.loads((SITE / f"notebooks/{path.name}").read_text())["cells"]
        assert any(cell.get("outputs") for cell in cells)
        assert f"]({path.name})" not in (SITE / f"notebooks/{path.stem}.html").read_text()


@in_chromium
def test_a_part_turns_on_a_page_of_the_site(tmp_path):
    page = dom((SITE / "viewer/hexbolt_m8x25.html").as_uri(), tmp_path)
    assert page.count('class="view"') == 3 and "has-views" in page
    assert 'src="viewer/hexbolt_m8x25.html"' in (SITE / "designer.html").read_text()
