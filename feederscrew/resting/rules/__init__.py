"""Rules that give the probability of each resting aspect, a module a family."""
