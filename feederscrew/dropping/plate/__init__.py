"""A virtual dynamic bowl test: many parts, one at a time, on a plate that vibrates with the bowl's drive.

Source: docs/resting.md, "On the vibrating plate"; the bowl tests of the thesis (MDBT).
"""
