"""Advice on a part: what makes it hard to feed, and which small change of its shape would make it easy."""
