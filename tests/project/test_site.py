"""The site of `make site` as a browser shows it: search, widths, dark, code to copy, formulas."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

SITE = Path(__file__).parents[2] / "site"
MISSING = not (SITE / "index.html").exists()
pytestmark = [pytest.mark.needs("chromium"), pytest.mark.skipif(MISSING, reason="make site makes it")]
PAGES = ("index", "validation", "commands", "method/trial")
FRAME = """<iframe src="{page}" style="border:0;width:{width}px;height:900px"></iframe>
<script>onload = () => {{ document.body.dataset.width =
  document.querySelector("iframe").contentDocument.documentElement.scrollWidth; }}</script>"""


def dom(address, tmp_path, *flags):
    call = [shutil.which("chromium"), "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", *flags]
    call += ["--allow-file-access-from-files", "--virtual-time-budget=8000", f"--user-data-dir={tmp_path}"]
    return subprocess.run([*call, address], capture_output=True, text=True, timeout=300).stdout


def test_search_copied_code_dark_pages_and_formulas_need_no_server_and_no_other_host(tmp_path):
    page = dom(f"{(SITE / 'index.html').as_uri()}?q=throw%20number", tmp_path)
    assert int(re.search(r"(\d+) matching documents", page)[1]) > 3
    assert "glossary.html" in page.partition("md-search-result__list")[2]
    page = dom((SITE / "gallery.html").as_uri(), tmp_path)
    pictures = (SITE.parent / "docs/gallery.md").read_text().count("savefig(")
    assert page.count("md-code__button") >= pictures <= page.count('src="gallery/')
    assert 'data-md-color-scheme="slate"' in page
    assert (SITE / "formulas.html").read_text().count("<math") > 10
    asked = re.compile(r'<(?:script|link|img)[^>]+(?:src|href)="https?://')
    assert not [page.name for page in SITE.rglob("*.html") if asked.search(page.read_text())]


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("name", PAGES)
def test_no_page_is_wider_than_the_window(tmp_path, name, width):
    """Tables and code scroll within themselves on a telephone."""
    (tmp_path / "frame.html").write_text(FRAME.format(page=(SITE / f"{name}.html").as_uri(), width=width))
    page = dom((tmp_path / "frame.html").as_uri(), tmp_path / "profile", f"--window-size={width + 100},1000")
    assert int(re.search(r'data-width="(\d+)"', page)[1]) <= width
