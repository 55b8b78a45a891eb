"""The commands of `gt-env`, one module each: they read options, call the code that does the work, print."""
