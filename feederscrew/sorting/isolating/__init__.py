"""Devices that let one orientation leave and return the others: searched, proposed, explained."""
