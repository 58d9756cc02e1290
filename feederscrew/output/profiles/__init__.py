"""Tables and figures of ``profiles``."""
