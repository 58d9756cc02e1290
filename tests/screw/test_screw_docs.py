"""Every example of docs/method/screws.md runs and prints what the page says."""

import doctest
import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "method" / "screws.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)


def test_the_page_has_examples():
    assert len(BLOCKS) >= 6
    assert all(">>>" in block for block in BLOCKS)


def test_the_examples_run():
    """In one session, from top to bottom, as a reader would type them."""
    text = "\n".join(BLOCKS)
    test = doctest.DocTestParser().get_doctest(text, {}, PAGE.name, str(PAGE), 0)
    report = []
    failed, tried = doctest.DocTestRunner(verbose=False).run(test, out=report.append)
    if failed:
        pytest.fail("".join(report))
    assert tried > 20
