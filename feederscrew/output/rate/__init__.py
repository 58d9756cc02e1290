"""Tables and figures of ``rate``."""
