"""The bowl as one closed body: floor, wall, helical track with its cuts and blades, outlet, hub."""
