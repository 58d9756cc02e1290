"""From velocity to well-oriented parts a minute.

Source of its factors: docs/conveying.md, "Commands"; of what devices pass: docs/tooling.md.
"""
