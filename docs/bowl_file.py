"""Bring up to date what is made from the keys of a bowl file: page, keywords of the library, configs/.

The page has tables of keys and devices, from the JSON Schema; the keywords are those of `BowlValues`.

Example: python docs/bowl_file.py          (writes docs/bowl_file.md, bowl/values.py and configs/)
         python docs/bowl_file.py --check  (status 1, and the differences, if one is out of date)
"""

import sys
import textwrap
from collections import Counter
from pathlib import Path

import generated

from feederscrew.bowl import documentation, friction_table
from feederscrew.bowl.schema import BOWL_KEYS

PAGE = Path(__file__).resolve().parent / "bowl_file.md"
KEYWORDS = PAGE.parent.parent / "feederscrew" / "bowl" / "values.py"
CONFIGS = PAGE.parent.parent / "configs"
BEGIN, END = "    {  # written by docs/bowl_file.py\n", "    },\n    total=False,\n"
LINE_LETTERS = 100  # of a line of keywords, without what it is set in
HEAD = "| Key | Default | From | To | Units | Meaning |\n|---|---|---|---|---|---|\n"


def filled(text):
    """Return the page with its tables as the schema has them."""
    made = documentation.json_schema()["properties"]
    kinds = made.pop("devices")["items"]["properties"]
    alone = {name: value for name, value in made.items() if "properties" not in value}
    parts = [HEAD, *(_row(name, value) for name, value in alone.items())]
    for section, value in made.items():
        if "properties" in value:
            parts.append(f"\n### `{section}`\n\n{value['description']}\n\n{HEAD}")
            parts += [_row(f"{section}.{word}", key) for word, key in value["properties"].items()]
    devices = "| Device | Of before | Example | Meaning |\n|---|---|---|---|\n"
    former = {value["description"]: kind for kind, value in kinds.items() if value.get("deprecated")}
    for kind, value in kinds.items():
        if value.get("deprecated"):
            continue
        meaning, example = value["description"].split(". Example: ")
        old = former.get(value["description"])
        devices += f"| `{kind}` | {f'`{old}`' if old else ''} | `{example}` | {meaning} |\n"
    friction = "| Lining | Part | Static | Kinetic | Down the track | Source |\n|---|---|---|---|---|---|\n"
    for family, lining, own in friction_table.rows():
        back = own.static_backward, own.kinetic_backward
        down = "" if back[0] is None else f"{back[0]:g}, {back[1]:g}"
        friction += f"| {lining} | {family} | {own.static:g} | {own.kinetic:g} | {down} | {own.source} |\n"
    text = between(text, "bowl keys", "".join(parts))
    return between(between(text, "devices", devices), "friction", friction)


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


def with_keywords(text):
    """Return the module with a keyword for each key whose name is in one section."""
    count = Counter(key.word for key in BOWL_KEYS)
    words = [key.word for key in BOWL_KEYS if count[key.word] == 1]
    before, _, rest = text.partition(BEGIN)
    keys = textwrap.wrap(" ".join(f'"{word}":_Value,' for word in words), LINE_LETTERS)
    lines = "".join(f"        {line}\n" for line in keys).replace(":_", ": ")
    return before + BEGIN + lines + END + rest.partition(END)[2]


def main():
    """Write or check; the exit status."""
    status, check = 0, generated.is_checking(__doc__)
    written = {
        PAGE: filled,
        KEYWORDS: with_keywords,
        CONFIGS / "bowl.yaml": lambda _: documentation.template(),
        CONFIGS / "feeder.schema.json": lambda _: documentation.schema_text(),
    }
    for path, make in written.items():
        status |= generated.bring_up(path, make(path.read_text(encoding="utf-8")), check)
    return status


if __name__ == "__main__":
    sys.exit(main())
