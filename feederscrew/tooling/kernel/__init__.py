"""The compiled verdict: a foot over a hole, followed over the whole passage."""
