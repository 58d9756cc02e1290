"""The loop from a part and a rate to a bowl that its own trial confirms."""
