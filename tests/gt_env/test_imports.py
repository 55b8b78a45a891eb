"""Who may import whom, and what an import loads."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import benchmarks
import estimators
import gt_env

PACKAGES = {p.__name__: Path(p.__file__).parent for p in (estimators, gt_env, benchmarks)}


def imported(path):
    """Top-level names of all that a module imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in (
            "import_module",
            "__import__",
        ):
            yield from (str(a.value).split(".")[0] for a in node.args if isinstance(a, ast.Constant))


IMPORTS = {
    (package, path.relative_to(root).as_posix()): set(imported(path))
    for package, root in PACKAGES.items()
    for path in sorted(root.rglob("*.py"))
}


def importers(name):
    return [f"{package}/{module}" for (package, module), names in IMPORTS.items() if name in names]


@pytest.mark.parametrize(
    ("package", "forbidden"),
    [
        ("estimators", {"gt_env", "benchmarks", "pybullet", "pybullet_data", "stable_baselines3", "torch"}),
        ("gt_env", {"benchmarks", "stable_baselines3", "torch"}),
        ("benchmarks", {"pybullet", "pybullet_data"}),
    ],
)
def test_no_package_imports_what_stands_above_it(package, forbidden):
    assert any(p == package for p, _ in IMPORTS)
    for (of, module), names in IMPORTS.items():
        if of == package:
            assert not names & forbidden, f"{of}/{module}"


def test_the_engine_is_imported_in_exactly_one_module():
    assert importers("pybullet") == ["gt_env/engine.py"]


def test_stable_baselines3_is_imported_in_at_most_one_module():
    assert len(importers("stable_baselines3")) <= 1


def test_within_estimators_only_the_wrappers_need_gymnasium():
    assert all("wrapper" in module for module in importers("gymnasium") if module.startswith("estimators/"))


def test_the_walk_sees_imports_inside_functions():
    assert "pybullet" in IMPORTS["gt_env", "engine.py"]  # it is imported in a function there


def run(code, root):
    return subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("package", ["gt_env", "estimators", "benchmarks"])
def test_importing_a_package_loads_no_engine_and_no_learning_library(package, pytestconfig):
    heavy = {"pybullet", "torch", "stable_baselines3", "matplotlib"}
    code = f"import sys, {package}; print(*{heavy} & set(sys.modules))"
    done = run(code, pytestconfig.rootpath)

    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == ""


def test_where_the_engine_is_missing_one_line_says_how_to_get_it(pytestconfig):
    code = """
import sys
sys.modules["pybullet"] = None
import gymnasium
try:
    gymnasium.make("gt_env:gt_env/Arena-v0")
except ImportError as error:
    print(error)
"""
    done = run(code, pytestconfig.rootpath)

    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 1
    assert "pybullet" in done.stdout
    assert "pip install 'gt-env[sim]'" in done.stdout
