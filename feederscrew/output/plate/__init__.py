"""Tables and figures of ``plate``."""
