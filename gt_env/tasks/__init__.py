"""What a robot is asked to do: start and goal, reward in named terms, end of the episode and success.

A task knows poses, and builds no bodies.
"""
