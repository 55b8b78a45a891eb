"""Many runs side by side: processes, clusters, and what is left of them when something fails."""
