"""From velocity to well-oriented parts a minute."""
