"""Which orientation passes a cut, and which cut lets only one orientation pass."""
