"""Errors of the domain: one root, so that a caller can catch them all."""


class GtEnvError(Exception):
    """Root of every error that this project raises on purpose."""


class MeasurementError(GtEnvError, ValueError):
    """A message from a sensor, or a pose, that cannot be what it says it is."""


class ConfigError(GtEnvError, ValueError):
    """A configuration or calibration value that is unknown, of the wrong type or out of range."""


class RecordingError(GtEnvError, ValueError):
    """A recording, log or trajectory file that cannot be read or written."""


class MissingExtraError(GtEnvError, ImportError):
    """A package that only some users need is not installed.

    Args:
        what: What was asked for, e.g. "the simulator".
        package: The package that is missing.
        extra: The extra of this distribution that installs it.
    """

    def __init__(self, what: str, package: str, extra: str) -> None:
        super().__init__(f"{what} needs {package}, which is not installed: pip install 'gt-env[{extra}]'")
        self.extra = extra
