"""A part on the bowl floor."""
