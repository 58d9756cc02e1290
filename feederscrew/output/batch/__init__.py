"""Tables and figures of ``batch``."""

SHEET = "contact_sheet{}.png"  # as many as the parts need: nothing, then _2, _3 ...
ACROSS, DOWN = 5, 8  # thumbnails on a sheet
