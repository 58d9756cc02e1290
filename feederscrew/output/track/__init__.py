"""Tables and figures of ``track``."""
