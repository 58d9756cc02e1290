"""Compiled motion of one rigid part of true shape on the moving track with its cuts, blades and wall."""
