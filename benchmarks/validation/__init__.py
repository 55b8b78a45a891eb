"""The thesis's validation, what goes beyond it, and what it is held against."""
