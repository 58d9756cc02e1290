"""Tables and figures of ``tune``."""
