"""A folder that only keeps what is written to it."""


class Kept(dict):
    """Stands in for a ResultFolder: the files of a command, by name."""

    def write(self, name, content):
        """Keep one file."""
        self[name] = content if isinstance(content, bytes) else content.encode()
