"""The outline of a part along the bowl wall, and its stable headings."""
