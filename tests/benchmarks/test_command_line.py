"""What the command line says where it is misunderstood, interrupted, or asked for too much."""

import sys

import pytest

from benchmarks.__main__ import main
from benchmarks.output import OutputError, check_writable, staged


@pytest.fixture
def gt_env(monkeypatch, tmp_path, capsys):
    """Run the command line in an empty folder; its exit status and what it printed."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["gt-env", *words])
        with pytest.raises(SystemExit) as end:
            main()
        said = capsys.readouterr()
        return end.value.code, said.out, said.err

    return run


@pytest.mark.parametrize(
    ("words", "wrong", "allowed"),
    [
        (["nope"], "'nope'", "validate, replay, score"),
        (["--nope"], "--nope", "--version"),
        (["validate", "--nope"], "--nope", "--stress"),
        (["validate", "--see", "1"], "--see", "--seed"),
        (["bench", "--seed", "x"], "'--seed'", "integer"),
        (["bench", "--seed", "-1"], "'--seed'", "greater than or equal to 0"),
        (["bench", "extra"], "extra", "unexpected"),
        (["replay"], "'FILE'", "recording"),
        (["train", "--algo"], "'--algo'", "ppo"),
        (["validate", "--quick=3"], "'--quick'", "does not take a value"),
        (["replay", "log.txt", "--out", __file__], "'--out'", "is a file"),
    ],
)
def test_a_usage_error_is_one_line_that_says_what_is_allowed(gt_env, tmp_path, words, wrong, allowed):
    status, out, err = gt_env(*words)

    assert (status, out) == (2, "")
    assert err.startswith("gt-env: ")
    assert err.count("\n") == 1
    assert wrong in err
    assert allowed in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["play", "replay"])
def test_a_wrong_method_is_refused_before_the_place_is_looked_at(gt_env, command):
    status, _, err = gt_env(command, *["log.txt"] * (command == "replay"), "--method", "nope")

    assert status == 1
    assert err.startswith("gt-env: --method nope: must be one of thesis, lrf, fused")
    assert err.count("\n") == 1


def test_its_help_has_a_whole_line_for_every_command(gt_env, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    _, out, _ = gt_env("--help")
    commands = out.split("Commands:")[1].strip().splitlines()

    assert len(commands) >= 8
    assert all(line.endswith(".") and not line.endswith("...") and "…" not in line for line in commands)


def test_without_a_command_it_shows_its_help(gt_env):
    status, out, err = gt_env()

    assert (status, out) == (2, "")
    assert "Usage: gt-env" in err


def test_it_states_its_version(gt_env):
    status, out, _ = gt_env("--version")

    assert status == 0
    assert out.startswith("gt-env ")
    assert out.count(".") == 2


class Interrupting:
    """Ctrl-C in the middle of an import."""

    def find_spec(self, name, path, target=None):
        if name == "benchmarks.cli":
            raise KeyboardInterrupt


def test_ctrl_c_while_packages_are_imported_is_one_line(gt_env, monkeypatch):
    monkeypatch.delitem(sys.modules, "benchmarks.cli", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Interrupting(), *sys.meta_path])

    assert gt_env("validate") == (130, "", "gt-env: interrupted\n")


def test_a_folder_that_is_only_asked_for_is_not_made(tmp_path):
    check_writable(tmp_path / "some/out")
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="file/out: cannot be written"):
        check_writable(tmp_path / "file/out")


def interrupted_in_the_middle(out):
    with staged(out) as folder:
        (folder / "half").touch()
        raise KeyboardInterrupt


def test_what_fails_leaves_the_place_as_it_was(tmp_path):
    (tmp_path / "there").mkdir()
    for out in (tmp_path / "new/out", tmp_path / "there"):
        with pytest.raises(KeyboardInterrupt):
            interrupted_in_the_middle(out)
    assert [path.name for path in tmp_path.rglob("*")] == ["there"]


def test_what_ends_well_is_there_beside_what_was(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out/before").touch()
    with staged(tmp_path / "out") as folder:
        (folder / "plots").mkdir()
        (folder / "plots/a.png").touch()
    assert sorted(str(p.relative_to(tmp_path / "out")) for p in tmp_path.glob("out/**/*")) == [
        "before",
        "plots",
        "plots/a.png",
    ]
