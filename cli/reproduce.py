"""``feeder reproduce``."""

from feederscrew_cli import grouped, options
from feederscrew_cli.options import Output


@grouped.command(short_help="The thesis's tables and figures, recomputed cell by cell.")
@options.output
def reproduce(out: Output) -> None:
    """Example: feeder reproduce -o results

    Compute every table (3-1 to 3-13) and figure (3-6 to 3-13, 5-1 to 5-7) of the thesis again and
    set each number beside the printed one. A number is exact to print, explained (by a named finding),
    or differs. What was measured or read off a lost drawing is given, not checked. The conclusions follow,
    and the recommendations of chapter 6.2 with where each is met and what is not.

    With -o: DIR/thesis/ with a CSV for each item, a PNG for each figure, the findings, and one page
    to read from top to bottom, thesis.md and thesis.html.
    """
    from feederscrew.thesis import reproduction

    with out.step("tables and figures"):
        items = reproduction.reproduce().items
    with out.folder("thesis", {}) as folder, out.step("files"):
        files = reproduction.write(folder.write, items) if folder else {}
    out.warn(
        *(f"{item.name}: a cell differs without a reason" for item in reproduction.unexplained_items(items))
    )
    out.show(reproduction.overview(items), reproduction.document(items, files))
