"""Tables of ``calibrate``."""
