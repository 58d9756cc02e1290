"""Tables, drawings and pictures of ``feeder tooling``."""
