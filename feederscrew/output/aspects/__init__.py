"""Tables and figures of ``aspects``."""
