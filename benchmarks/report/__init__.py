"""Reports: the same numbers as JSON, as tables in the terminal and as a page with figures.

Only here are metres shown as millimetres and radians as degrees.
"""
