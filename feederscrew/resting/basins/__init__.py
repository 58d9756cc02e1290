"""Basins of the height of the centre of mass over all attitudes: sinks, saddles, barriers."""
