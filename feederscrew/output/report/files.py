"""A report as files."""

from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import CsvSheet, Picture

FORMATS = ("html", "md")
BESIDE = "report/"  # folder of the pictures, beside the text


def write(folder, page, format) -> None:
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
    folder.write("report.md", markdown(page, BESIDE))
    for section in page.sections:
        for block in section.blocks:
            if isinstance(block, Picture):
                folder.write(f"{BESIDE}{block.file}", block.content)
            elif isinstance(block, CsvSheet):
                folder.write(f"{BESIDE}{block.file}", block.csv)
