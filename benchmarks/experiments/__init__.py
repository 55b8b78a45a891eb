"""The experiments: what is simulated, from where and with which commands. Metrics say what it was worth."""
