"""On which sides a part comes to rest, and how often: the second stage.

Source of its rules, with their papers: docs/resting.md and docs/equations.md.
"""
