"""Bring docs/bowl_file.md up to date: the tables of keys and devices.

Example: python docs/bowl_file.py          (writes docs/bowl_file.md)
         python docs/bowl_file.py --check  (status 1, and the differences, if it is out of date)
"""

import difflib
import sys
from pathlib import Path

from feederscrew.bowl import documentation

PAGE = Path(__file__).resolve().parent / "bowl_file.md"


def filled(text):
    """Return the page with its tables as the program has them."""
    text = between(text, "bowl keys", documentation.markdown())
    return between(text, "devices", documentation.devices_markdown())


def between(text, name, content):
    """Return the text with new content between the two marks of a name."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, _, rest = text.partition(begin)
    return before + begin + content + end + rest.partition(end)[2]


def main():
    """Write or check; the exit status."""
    old = PAGE.read_text(encoding="utf-8")
    new = filled(old)
    if "--check" in sys.argv:
        sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), "page", "now"))
        return int(old != new)
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
