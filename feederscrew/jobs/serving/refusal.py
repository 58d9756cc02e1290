"""Requests that are not answered, and faults in the words of the page."""

import re

from feederscrew.bowl.schema import BOWL_SECTIONS

OFFERED = {  # arguments and options that the page has, by its words for them
    "units": "length unit",
    "density": "material",
    "target": "parts a minute",
    "drive": "machine",
}
NAMED = re.compile(r"`([a-z_]+)`|--([a-z][a-z-]*)")  # an argument of the library, an option of the command
CALLED = re.compile(r"\b(?:pass|give|write|set|use)\s+(?:`([a-z_]+)`|--([a-z][a-z-]*))")
BOWL_KEY = re.compile(rf"\b(?:{'|'.join(BOWL_SECTIONS)})\.[a-z_]+")  # a page has no field for it
BETWEEN_WAYS = re.compile(r"(,? or |, )(?![^(]*\))")  # not within brackets
ELSEWHERE = "mend the file in CAD, and drop it again"


class Refusal(Exception):
    """A request that is not answered: its status and one line that says why and how to mend it."""

    def __init__(self, status: int, line: str) -> None:
        super().__init__(line)
        self.status = status


def in_words_of_the_page(line: str, elsewhere: str = ELSEWHERE) -> str:
    """Return the line of a fault with a mend that names only what the page offers.

    Parameters
    ----------
    line : str
        'where: what - mend', with `arguments` of the library or --options of the command line.
    elsewhere : str
        The mend where every other one needs the command line.

    Returns
    -------
    str
        Alternatives of the mend that name something else are left out; what the page has goes by its label.
    """
    head, dash, mend = line.rpartition(" - ")
    said = NAMED.sub(_label, head if dash else line)
    return f"{said} - {_offered_ways(mend) or elsewhere}" if dash else said


def _label(name: re.Match[str]) -> str:
    word = name[1] or name[2]
    return OFFERED.get(word, word.replace("_", " "))


def _offered_ways(mend: str) -> str:
    """Those of the alternatives of a mend that the page offers, with what stands between them."""
    first, *more = BETWEEN_WAYS.split(mend)
    ways = [["", first]]
    for between, way in zip(more[::2], more[1::2]):
        if ways[-1][1].startswith("if "):  # a condition goes with what follows it
            ways[-1][1] += f"{between}{way}"
        else:
            ways.append([between, way])
    kept = [(between, _relabelled(way)) for between, way in ways if way and _is_offered(way)]
    return "".join(way if place == 0 else f"{between}{way}" for place, (between, way) in enumerate(kept))


def _is_offered(way: str) -> bool:
    return not BOWL_KEY.search(way) and all((name[1] or name[2]) in OFFERED for name in NAMED.finditer(way))


def _relabelled(way: str) -> str:
    return NAMED.sub(_label, CALLED.sub(lambda name: f"choose the {_label(name)}", way))
