"""Tables and figures of ``solid``."""
