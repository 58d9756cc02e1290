"""Many parts at once, the main job in a browser, and files to begin with."""
