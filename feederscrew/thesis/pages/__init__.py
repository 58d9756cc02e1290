"""Tables and figures of ``thesis``."""
