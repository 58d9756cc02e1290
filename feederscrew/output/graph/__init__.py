"""Tables and figures of ``graph``."""
