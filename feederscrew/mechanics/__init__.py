"""How a part moves in the bowl: limits, floor, track, conveying."""
