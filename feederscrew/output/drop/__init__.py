"""Tables and figures of ``drop``."""
