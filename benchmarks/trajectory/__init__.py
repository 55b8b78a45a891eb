"""Trajectories: what they are, their files, pairing them by stamp, alignment, and offsets between them."""
