"""Tables, plots, pictures and result folders: the last stage."""
