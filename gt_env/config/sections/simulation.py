"""Light, physics and time."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from pydantic import Field

from gt_env.config.sections.fields import Color, Flag, NotNegative, Positive, Real, Whole, section


@section
class LampConfig:
    """One lamp.

    Attributes:
        position: x, y, z [m].
        intensity: Of its diffuse light, as a fraction of full white.
        color: RGB.
    """

    position: tuple[Real, Real, Real] = (0.0, 0.10, 0.60)
    intensity: NotNegative = 0.35
    color: Color = (255, 255, 255)


@section
class LightConfig:
    """Lamps and what lies beyond the walls.

    Attributes:
        ambient: Light from everywhere, as a fraction of full white.
        lamps: The thesis has one, close to the camera.
        temperature: Colour temperature [K]; 6500 leaves colours as they are. Another needs the `fast` renderer.
        shadow: Whether the lamps cast shadows.
        backdrop_color: RGB of what is seen above the walls; not a grey, which the thesis takes for target.
    """

    ambient: NotNegative = 0.60
    lamps: tuple[LampConfig, ...] = field(default_factory=lambda: (LampConfig(),))
    temperature: Annotated[float, Field(strict=True, ge=1667, le=25000)] = 6500.0
    shadow: Flag = False
    backdrop_color: Color = (70, 100, 150)


@section
class PhysicsConfig:
    """The physics engine.

    Attributes:
        friction: Between wheels and floor.
        solver_iterations: Of the contact solver, per tick.
        gravity: [m/s^2].
    """

    friction: NotNegative = 0.9
    solver_iterations: Whole = 50
    gravity: NotNegative = 9.81


@section
class TimingConfig:
    """Time steps.

    Attributes:
        tick: Of the physics [s]; every sensor's period is a whole multiple of it.
        step: Of the environment [s], a whole multiple too.
    """

    tick: Positive = 1 / 240
    step: Positive = 0.1
