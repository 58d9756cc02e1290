"""Tables and figures of ``batch``."""
