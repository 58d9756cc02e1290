"""Tables and figures of ``inertia``."""
