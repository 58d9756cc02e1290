"""Tables and figures of ``slide``."""
