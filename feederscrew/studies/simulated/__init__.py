"""The studies that simulate drops, and what a run has simulated already."""
