"""The devices along a track, a family a module: how each is written, what it cuts and what it lets pass."""
