"""Tables and figures of ``trial``."""
