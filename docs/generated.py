"""What the scripts of this folder share: they write generated pages, or compare them with ``--check``."""

import argparse
import difflib
import sys


def is_checking(about):
    """Return whether the call has ``--check``; ``--help`` prints ``about``, another option is refused."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--check", action="store_true", help="print how the pages differ, write nothing")
    return parser.parse_args().check


def bring_up(path, new, check):
    """Write a page, or print how it differs where it is checked; 1 if it does."""
    old = path.read_text(encoding="utf-8") if path.exists() else ""
    if not check:
        path.write_text(new, encoding="utf-8")
        return 0
    sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), path.name, "now"))
    return int(old != new)
