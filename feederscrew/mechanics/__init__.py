"""Motion of a part in the bowl: limits, floor, track, conveying.

Source: the thesis by the numbers of its equations; docs/mechanics.md and docs/equations.md.
"""
