"""The gate: what makes triangles one closed solid, what is mended, and what is refused."""
