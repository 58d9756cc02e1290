"""A design of a bowl as document, table, bowl file, page and acceptance sheet."""
