"""Pages for people: blocks, and their writers in HTML and Markdown; what they say comes from elsewhere."""
