"""Self-calibrations of recordings, and what they are worth."""
