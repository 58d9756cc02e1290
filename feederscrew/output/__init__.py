"""Tables, plots, pictures and result folders: the last stage."""

DPI = 160  # pixels of a picture to the inch of its figure
