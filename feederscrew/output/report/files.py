"""A report as files."""

from feederscrew.output.report.as_html import html
from feederscrew.output.report.as_markdown import BESIDE, markdown
from feederscrew.output.report.blocks import Picture, Sheet

FORMATS = ("html", "md")


def write(folder, page, format):
    """Write one HTML file, or Markdown with its pictures beside it.

    Parameters
    ----------
    folder : ResultFolder
    page : Page
    format : str
        ``'html'`` or ``'md'``.
    """
    if format == "html":
        folder.write("report.html", html(page))
        return
    folder.write("report.md", markdown(page))
    for section in page.sections:
        for block in section.blocks:
            if isinstance(block, Picture):
                folder.write(f"{BESIDE}/{block.file}", block.content)
            elif isinstance(block, Sheet):
                folder.write(f"{BESIDE}/{block.file}", block.csv)
