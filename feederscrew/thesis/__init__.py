"""The thesis: its tables as printed, what is wrong with them, and every number of it computed again."""
