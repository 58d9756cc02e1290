"""A part on the track against the bowl wall."""
