"""Configurations from presets, TOML files and mappings."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from estimators.errors import ConfigError
from gt_env.config.merging import merge, nested
from gt_env.config.schema import EnvConfig

ConfigLike = EnvConfig | Mapping[str, Any] | str | Path | None
DEFAULT_PRESET = "thesis"


def presets() -> tuple[str, ...]:
    """Names of the presets that come with the package."""
    found = (files("gt_env") / "presets").iterdir()
    return tuple(sorted(p.name.removesuffix(".toml") for p in found if p.name.endswith(".toml")))


def load_config(
    config: ConfigLike = None, overrides: Mapping[str, Any] | None = None, default: str = DEFAULT_PRESET
) -> EnvConfig:
    """Make a configuration.

    Args:
        config: An `EnvConfig`, a mapping, a preset's name, or the path of a TOML file. Mapping and file may
            be partial: they are laid over the preset that their key `preset` names (a list of names lays
            several over one another), or over `default`.
        overrides: Values to lay over that, e.g. `{"lrf.rate": 20}`.
        default: Preset that counts where none is named.

    Raises:
        ConfigError: If there is no such preset or file, a key is unknown, or a value is of the wrong type or
            out of range; the message names file, key, value and what is allowed.
    """
    values, origin = _values(config, default)
    for key, value in (overrides or {}).items():
        values = merge(values, nested(key, value))
    if isinstance(config, EnvConfig) and not overrides:
        return config
    return _build(values, origin)


def parse_override(text: str) -> tuple[str, Any]:
    """`"lrf.rate=20"` as key and value; the value is read as TOML, or as a string where it is none.

    Raises:
        ConfigError: If there is no `=`.
    """
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ConfigError(f"{text!r}: must be KEY=VALUE, for example lrf.noise_sigma=0.01")
    try:
        return key.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key.strip(), value.strip()


def _values(config: ConfigLike, default: str) -> tuple[dict[str, Any], str]:
    """All values, presets resolved, and where they came from."""
    if config is None:
        return _preset(default), default
    if isinstance(config, EnvConfig):
        return config.as_dict(), "config"
    if isinstance(config, Mapping):
        return _over_preset(config, "config", default), "config"
    if isinstance(config, str) and config in presets():
        return _preset(config), config
    if not isinstance(config, str | Path):
        raise ConfigError(f"config = {config!r}: must be an EnvConfig, a mapping, a preset's name or a path")
    path = Path(config)
    if not path.is_file():
        raise ConfigError(
            f"config = {str(config)!r}: must be a TOML file that exists or one of the presets "
            f"{', '.join(presets())}"
        )
    return _over_preset(_read_toml(path.read_bytes(), str(path)), str(path), default), str(path)


def _preset(name: str) -> dict[str, Any]:
    if name not in presets():
        raise ConfigError(f"preset = {name!r}: must be one of {', '.join(presets())}")
    content = (files("gt_env") / "presets" / f"{name}.toml").read_bytes()
    return _over_preset(_read_toml(content, f"{name}.toml"), f"{name}.toml")


def _over_preset(values: Mapping[str, Any], origin: str, default: str = DEFAULT_PRESET) -> dict[str, Any]:
    values = dict(values)
    names = values.pop("preset", None)
    if names is None:
        names = [] if origin == f"{DEFAULT_PRESET}.toml" else [default]
    elif isinstance(names, str):
        names = [names]
    if not isinstance(names, Sequence) or not all(isinstance(n, str) for n in names):
        raise ConfigError(f"{origin}: preset = {names!r}: must be a name or a list of names")
    merged: dict[str, Any] = {}
    for name in names:
        merged = merge(merged, _preset(name))
    return merge(merged, values)


def _read_toml(content: bytes, origin: str) -> dict[str, Any]:
    try:
        return tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{origin}: not a TOML file: {error}") from None


def _build(values: dict[str, Any], origin: str) -> EnvConfig:
    if isinstance(values.get("belief"), Mapping) and values["belief"]:
        _build({**values, "belief": {}}, origin)  # what is left to complain about is the belief's
        origin = f"{origin}: belief"
    try:
        return EnvConfig(**values)
    except ConfigError as error:
        raise ConfigError(f"{origin}: {error}") from None
    except ValidationError as error:
        raise ConfigError(f"{origin}: {'; '.join(_explain(error))}") from None
    except TypeError as error:
        raise ConfigError(f"{origin}: {error}") from None


def _explain(error: ValidationError) -> list[str]:
    """One phrase per error of the validator: key, value, what is allowed."""
    phrases = []
    for item in error.errors(include_url=False):
        key = ".".join(str(part) for part in item["loc"])
        if item["type"] == "value_error":  # raised by a check of ours, which names its key itself
            phrases.append(str(item["ctx"]["error"]))
        elif item["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
            phrases.append(f"unknown key {key} = {item['input']!r}{_known_keys(item['loc'][:-1])}")
        else:
            phrases.append(f"{key} = {item['input']!r}: {item['msg'][0].lower()}{item['msg'][1:]}")
    return phrases


def _known_keys(section: tuple[int | str, ...]) -> str:
    fields: dict[str, Any] = vars(EnvConfig)["__dataclass_fields__"]
    if not section:
        return f": must be one of {', '.join(fields)}"
    factory: Any = fields[str(section[0])].default_factory if section[0] in fields else None
    known = getattr(factory, "__dataclass_fields__", None)
    return f": {section[0]} has {', '.join(known)}" if known and len(section) == 1 else ""
