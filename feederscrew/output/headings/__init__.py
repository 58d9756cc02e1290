"""Tables and figures of ``headings``."""
