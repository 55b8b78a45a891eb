"""The camera in closed form: fast, anti-aliased by area, without the physics engine.

Import `gt_env.fast_camera.renderer` only where it is used: it loads numba.
"""
