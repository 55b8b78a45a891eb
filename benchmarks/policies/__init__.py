"""Policies that nobody trained: all answer `predict()`, as those of stable-baselines3 do."""
