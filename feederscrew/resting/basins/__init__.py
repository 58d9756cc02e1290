"""Basins of the height of the centre of mass over all attitudes: sinks, saddles, barriers.

Source: docs/resting.md, "Exact tumbling" and "Barriers and the tipping graph".
"""
