# make          virtual environment, install, validation against the thesis's tables
# make test     the same with the developers' tools: linters, types, tests (SLOW=1: the long ones too)

PYTHON ?= python3
BIN := .venv/bin
PIP_INSTALL := $(BIN)/python -m pip install --disable-pip-version-check --quiet --constraint constraints.txt
PYTEST := $(BIN)/python -m pytest -n 2 $(if $(SLOW),-m "")

.PHONY: validate test lint clean

validate: .venv/installed
	$(BIN)/gt-env validate

test: .venv/installed-dev lint
	$(PYTEST)

lint: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

.venv/bin/python:
	$(PYTHON) -m venv .venv

.venv/installed: .venv/bin/python pyproject.toml constraints.txt
	@echo "installing gt-env into .venv"
	$(PIP_INSTALL) --editable '.[report,fast]'
	@touch $@

.venv/installed-dev: .venv/installed
	@echo "installing the developers' tools into .venv"
	$(PIP_INSTALL) --editable '.[dev]'
	@touch $@

clean:
	rm -rf .venv out build *.egg-info .mypy_cache .ruff_cache .pytest_cache
