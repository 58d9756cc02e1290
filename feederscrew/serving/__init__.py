"""The main job in a browser on this machine: a part, its aspects, a design, its result page."""
