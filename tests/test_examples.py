"""What the documentation tells the reader to type is understood, and its short pieces of Python run."""

import re
import shlex
from pathlib import Path

import pytest
from typer.main import get_command

from benchmarks.cli import app
from gt_env.config import load_config, parse_override

ROOT = Path(__file__).parents[1]
PAGES = {page.name: page.read_text() for page in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])}
SHORT = ("localizers.md", "recordings.md", "scoring.md", "tasks.md")
COMMANDS = get_command(app).commands


def typed(text):
    """Command lines of `gt-env` in a page: in blocks, and in a sentence if they have arguments."""
    blocks = "\n".join(re.findall(r"```sh\n(.*?)```", text, re.S)).replace("\\\n", " ")
    lines = [line.partition("#")[0] for line in blocks.splitlines()]
    parts = [part.strip() for line in lines for part in re.split(r"&&|[;|]", line)]
    prose = re.findall(r"`(gt-env [^`]*)`", re.sub(r"```.*?```", "", text, flags=re.S))
    words = [shlex.split(part) for part in parts if part.startswith("gt-env ")]
    return words + [line for line in map(shlex.split, prose) if len(line) > 2]


@pytest.mark.parametrize("page", PAGES)
def test_every_command_is_understood(page):
    for _, name, *arguments in typed(PAGES[page]):
        assert name in COMMANDS
        asked = COMMANDS[name].make_context(name, arguments).params
        assert asked
        config = asked.get("config")
        if config and not set(config) & set("./"):  # a preset
            load_config(config, dict(map(parse_override, asked["overrides"] or ())))


def test_there_are_commands():
    assert len(typed(PAGES["validation.md"])) > 5
    assert len(typed(PAGES["README.md"])) > 5


@pytest.mark.parametrize("page", SHORT)
def test_every_piece_of_python_runs(page, tmp_path, monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "documentation"}
    pieces = re.findall(r"```python\n(.*?)```", PAGES[page], re.S)
    for piece in pieces:
        exec(piece, names)

    assert pieces
    for made in ("env", "arena"):
        if made in names:
            names[made].close()


def test_the_recording_that_is_shown_holds_every_step_to_its_end(tmp_path, monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.chdir(tmp_path)
    (piece,) = re.findall(r"```python\n(.*?)```", PAGES["recordings.md"], re.S)
    names = {}
    exec(piece, names)
    recording = names["recording"]

    assert recording.truth[[0, -1], 0] == pytest.approx([0.0, 2.0])
    scans = [m.stamp for m in recording.messages if m.source == "station/lrf"]
    assert scans == pytest.approx([0.1 * i for i in range(21)])


def test_pages_close_the_environments_that_they_make():
    pieces = [p for page in PAGES.values() for p in re.findall(r"```python\n(.*?)```", page, re.S)]
    for piece in pieces:
        vectors = re.findall(r"^ *(\w+) = (?:gym\.make_vec|SubprocVecEnv)\(", piece, re.M)
        assert all(f"{name}.close()" in piece for name in vectors), piece
