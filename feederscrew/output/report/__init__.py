"""One page on a part in a bowl: what is known of it, as an HTML file that needs no other, or as Markdown."""

from feederscrew.output.report.chapters import page, write

__all__ = ["page", "write"]
