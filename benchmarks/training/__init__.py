"""Learning to drive by what the station sees."""
