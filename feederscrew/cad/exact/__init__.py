"""The bowl with exact faces, as a STEP file: its door to OpenCASCADE."""
