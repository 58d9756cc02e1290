"""Tables and figures of ``floor``."""
