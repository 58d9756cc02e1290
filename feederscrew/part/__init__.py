"""From a file to a solid with mass properties: the first stage."""
