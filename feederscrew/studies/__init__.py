"""One study a command: one function from inputs to one frozen record."""
