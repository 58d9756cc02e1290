"""From a file's bytes to triangles, and from these and the user's options to a ``Part``."""
