"""The commands; arithmetic lives in feederscrew."""
