"""How robots are driven: segments, paths and who follows them."""
