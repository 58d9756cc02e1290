"""Make the long description of a wheel: the README, its relative pictures and links absolute or left out.

A package index shows it on a page that has no files beside it: a picture or a link to `docs/...` leads
nowhere. The table `[tool.hatch.metadata.hooks.custom]` of pyproject.toml says under which addresses the files
of the project can be read, once it has a host. Without them the description has no relative picture, and of a
relative link it has the words alone.
"""

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(?P<picture>!?)\[(?P<words>[^\]]*)\]\((?P<target>[^)\s]+)\)")
ABSOLUTE = re.compile(r"[a-z][a-z0-9+.-]*:|#", re.IGNORECASE)  # a scheme, or a place on the same page
EMPTY_LINES = re.compile(r"\n{3,}")


class Description(MetadataHookInterface):
    """Give the wheel the README as its long description, fit for a page without files beside it."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Set ``readme`` of the project's table."""
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        addresses = (self.config.get(name, "") for name in ("pages", "pictures"))
        metadata["readme"] = {"content-type": "text/markdown", "text": describe(text, *addresses)}


def describe(text: str, pages: str = "", pictures: str = "") -> str:
    """Return a README for a package index: its relative pictures and links absolute, or left out.

    Parameters
    ----------
    text : str
        The README, in Markdown. Fenced blocks stay as they are.
    pages, pictures : str
        Addresses of the folder of the README: the one that shows its pages, and the one that sends its
        pictures. Without ``pages`` only the words of a link stay, without ``pictures`` nothing of a picture.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If an address does not begin with https://.
    """
    for address in (pages, pictures):
        if address and not address.startswith("https://"):
            raise ValueError(
                f"pyproject.toml: [tool.hatch.metadata.hooks.custom]: '{address}' is no address on a package "
                "index - begin it with https://, or leave it empty"
            )

    def absolute(link: re.Match[str]) -> str:
        picture, words, target = link.group("picture", "words", "target")
        address = pictures if picture else pages
        if ABSOLUTE.match(target):
            return link[0]
        if address:
            return f"{picture}[{words}]({address.rstrip('/')}/{target})"
        return "" if picture else words

    parts, end = [], 0
    for block in FENCED.finditer(text):
        parts += [LINK.sub(absolute, text[end : block.start()]), block[0]]
        end = block.end()
    return EMPTY_LINES.sub("\n\n", "".join([*parts, LINK.sub(absolute, text[end:])]))
