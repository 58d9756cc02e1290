"""On which sides a part comes to rest, and how often: the second stage."""
