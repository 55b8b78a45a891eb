"""What it was worth: rollouts, recordings, metrics, experiments, reports and the command line."""
