"""Words for people on pages: shares in percent, the glossary, remarks that call for no step."""

import re
from pathlib import Path

from feederscrew.base.errors import Detail
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Chapter, Folded, Page, Text
from feederscrew.output.page.words import GLOSSARY

DOCS = Path(__file__).parents[2] / "docs"


def test_words_of_pages_have_the_meaning_that_the_glossary_gives():
    listed = (DOCS / "glossary.md").read_text().replace("`", "")
    for word, meaning in GLOSSARY.items():
        assert f"| {word} | {meaning}" in listed, word


def test_a_page_names_the_glossary_and_explains_the_words_that_it_uses():
    page = Page("washer", "", (Chapter((Text("The purity is 99 %."),), anchor="x", title="X"),))
    text = html(page)
    assert "docs/glossary.md" in text and "docs/glossary.md" in markdown(page)
    words = re.findall(r"<dt>(.*?)</dt>", text)
    assert words == ["purity"]


def test_a_detail_is_no_warning_at_the_head_and_stands_folded_in_its_chapter():
    lines = "turn it round", Detail("p_pmi of A 0.608 for 0.981")
    page = Page("bolt", "", (Chapter((Folded("design.yaml", "a: <1>"),), warnings=lines, title="X"),))
    assert page.warnings == ("turn it round",)
    head, _, body = html(page).partition("</header>")
    assert "turn it round" in head and "p_pmi" not in head
    folded = re.findall(r"<details>.*?</details>", body, re.S)
    assert "a: &lt;1&gt;" in folded[0] and "p_pmi" in folded[1]
    assert "p_pmi" in markdown(page).replace("\\", "")
