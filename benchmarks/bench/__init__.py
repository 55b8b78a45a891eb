"""How fast the project is, in ratios that are measured side by side in one run."""
