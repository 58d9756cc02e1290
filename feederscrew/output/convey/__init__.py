"""Tables and figures of ``convey``."""
