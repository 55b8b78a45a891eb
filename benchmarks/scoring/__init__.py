"""What a localizer is worth, judged by the station, and whether the station may judge it."""
