"""What may go wrong between two parts, or a part and two walls, said before steel is cut."""
