"""Policies put to the test, judged by the truth and by what the station saw."""
