"""Profiles that were measured, their comparison with the rules, and calibration from them."""
