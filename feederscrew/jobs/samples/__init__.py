"""Files to begin with, which `feeder sample` writes: parts, some by their sizes, a bowl file, counts."""
