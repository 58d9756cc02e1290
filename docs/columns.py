"""Bring docs/columns.md up to date: every column that a record declares.

Example: python docs/columns.py          (writes the page)
         python docs/columns.py --check  (status 1 if it is out of date)
"""

import ast
import sys
from importlib import import_module
from pathlib import Path

import generated

PAGE = Path(__file__).resolve().parent / "columns.md"
LIBRARY = PAGE.parents[1] / "feederscrew"
INTRODUCTION = """# Columns

<!-- docs/columns.py writes this page -->

Each result declares its columns once, beside its record. The CSV and JSON files of the commands, the printed
tables, `to_frame` and the pages are made of these. A name in a file ends in its unit. A share is a fraction
in files; tables for people show it in percent. A column with an interval has two more beside it, `_low` and
`_high`. A hidden column stands in files alone.

"""
ROW = "| {} |\n"
TITLES = ("Name in files", "Unit", "Above the column", "Interval", "Hidden")


def declared():
    """Yield module, record, name, comment and columns of each tuple of columns, module by module."""
    for path in sorted(LIBRARY.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if "tuple[Column[" not in source:
            continue
        lines = source.splitlines()
        name = ".".join(path.relative_to(LIBRARY.parent).with_suffix("").parts)
        for node in ast.parse(source).body:
            kind = ast.unparse(node.annotation) if isinstance(node, ast.AnnAssign) else ""
            if kind.startswith("tuple[Column["):
                record = kind.removeprefix("tuple[Column[").removesuffix("], ...]")
                comment = lines[node.lineno - 1].partition("#")[2].strip()
                yield name, record, node.target.id, comment, getattr(import_module(name), node.target.id)


def page():
    """Return the page: a section a module, a table each tuple of columns."""
    text, last = [INTRODUCTION], ""
    for module, record, name, comment, columns in declared():
        if module != last:
            text.append(f"## `{module}`\n\n")
            last = module
        text.append(f"`{record}` (`{name}`){f', {comment}' if comment else ''}:\n\n")
        text += [ROW.format(" | ".join(cells)) for cells in (TITLES, ["---"] * len(TITLES))]
        for column in columns:
            marks = ("yes" if mark else "" for mark in (column.interval, column.hidden))
            cells = (f"`{column.name}`", column.unit or "-", column.head.title, *marks)
            text.append(ROW.format(" | ".join(cells)))
        text.append("\n")
    return "".join(text).rstrip() + "\n"


if __name__ == "__main__":
    sys.exit(generated.bring_up(PAGE, page(), generated.is_checking(__doc__)))
