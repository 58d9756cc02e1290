"""What a subject offers of its study: files by name, each made only when it is asked for."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from feederscrew.heavy import heavy
from feederscrew.output import tables

style = heavy("feederscrew.output.style")


@dataclass(frozen=True, eq=False)
class Offer:
    """One file: its name, how its content is made, and for a picture what it shows."""

    name: str
    make: Callable[[], str | bytes]
    alt: str = ""
    view: Callable[[], Any] | None = None  # the frame, the document or the figure itself

    @property
    def is_picture(self) -> bool:
        """Whether it is left out where no pictures are wanted."""
        return self.name.endswith(".png")


def table(name: str, make: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a CSV file; ``make`` returns the frame, or its columns as a dict, of the other arguments."""

    def view() -> Any:
        content = make(*arguments, **keywords)
        return tables.frame(content) if isinstance(content, dict) else content

    return Offer(name, lambda: tables.text(view(), "csv"), view=view)


def document(name: str, make: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a JSON file; ``make`` returns the document."""
    view = partial(make, *arguments, **keywords)
    return Offer(name, lambda: tables.json_text(view()), view=view)


def text(name: str, make: Callable[..., str | bytes], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a file of text or of bytes as ``make`` returns it."""
    return Offer(name, partial(make, *arguments, **keywords))


def picture(name: str, alt: str, draw: Callable[..., Any], *arguments: Any, **keywords: Any) -> Offer:
    """Offer a PNG of what ``alt`` says; ``draw`` returns the figure of the other arguments."""
    view = partial(draw, *arguments, **keywords)
    return Offer(name, lambda: style.png(view()), alt, view)


def write(folder: Any, offered: Iterable[Offer], *, pictures: bool = True) -> None:
    """Make every file offered and hand it to a ResultFolder, the numbers first; nothing without a folder.

    An interrupt while a picture is drawn leaves out that one and those after it: ``folder.left_out``
    names them, and the tables are kept. Without ``pictures`` only tables and documents are made.
    """
    if folder is None:
        return
    by_kind = sorted(offered, key=lambda offer: offer.is_picture)  # numbers first
    wanted = [offer for offer in by_kind if pictures or not offer.is_picture]
    for place, offer in enumerate(wanted):
        try:
            folder.write(offer.name, offer.make())
        except KeyboardInterrupt:
            if not offer.is_picture:
                raise
            folder.left_out += [missing.name for missing in wanted[place:]]
            return


def by_name(offered: Iterable[Offer]) -> dict[str, Offer]:
    """Return the offers of a subject by the names of their files."""
    return {offer.name: offer for offer in offered}
