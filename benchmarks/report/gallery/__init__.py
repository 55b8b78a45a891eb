"""The figures of a validation's report, with their files and captions."""
