"""Tables and figures of ``compare``."""
