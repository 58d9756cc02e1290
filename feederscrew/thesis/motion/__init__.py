"""The thesis's equations of motion as printed, beside the complete ones."""
