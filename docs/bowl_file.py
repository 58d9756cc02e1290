"""Bring docs/bowl_file.md up to date: the tables of keys and devices, from the JSON Schema.

Example: python docs/bowl_file.py          (writes docs/bowl_file.md)
         python docs/bowl_file.py --check  (status 1, and the differences, if it is out of date)
"""

import difflib
import sys
from pathlib import Path

from feederscrew.bowl import json_schema

PAGE = Path(__file__).resolve().parent / "bowl_file.md"
HEAD = "| Key | Default | From | To | Units | Meaning |\n|---|---|---|---|---|---|\n"


def filled(text):
    """Return the page with its tables as the schema has them."""
    made = json_schema.schema()["properties"]
    kinds = made.pop("devices")["items"]["properties"]
    alone = {name: value for name, value in made.items() if "properties" not in value}
    parts = [HEAD, *(_row(name, value) for name, value in alone.items())]
    for section, value in made.items():
        if "properties" in value:
            parts.append(f"\n### `{section}`\n\n{value['description']}\n\n{HEAD}")
            parts += [_row(f"{section}.{word}", key) for word, key in value["properties"].items()]
    devices = "| Device | Example | Meaning |\n|---|---|---|\n"
    for kind, value in kinds.items():
        meaning, example = value["description"].split(". Example: ")
        devices += f"| `{kind}` | `{example}` | {meaning} |\n"
    return between(between(text, "bowl keys", "".join(parts)), "devices", devices)


def _row(name, value):
    said, _, left_out = value["description"].rpartition(" Left out: ")
    default = f"{value['default']}" if "default" in value else left_out.removesuffix(".")
    meaning = said or value["description"].rpartition(" Default: ")[0]
    meaning = meaning.rpartition(". From ")[0] or meaning.rpartition(". One of ")[0]
    units = ", ".join(value["x-units"])
    return f"| `{name}` | {default} | {value['x-lowest']} | {value['x-highest']} | {units} | {meaning} |\n"


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
