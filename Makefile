# Each target does all its own set-up, in a virtual environment that git ignores.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Optional parts to install besides the package and its developers' tools, as in EXTRAS=sim.
EXTRAS ?=

comma := ,
STAMP := $(VENV)/.installed$(subst $(comma),-,$(EXTRAS))

.PHONY: demo pictures test lint types layers docs check clean

demo: $(STAMP)
	$(BIN)/wnn2hdl demo

# The pictures that README and the pages show, made by the demo.
pictures: demo
	$(BIN)/python docs/pictures.py build/demo docs/pictures

# A process for each core, but each needs up to a gigabyte. The tests of a file share what they build.
# Which lines they run is measured, and `.venv/bin/coverage report` lists them; pyproject.toml has the floor.
test: $(STAMP)
	$(BIN)/pytest --numprocesses logical --maxprocesses 4 --dist loadfile --cov --cov-report=

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

layers: $(STAMP)
	$(BIN)/lint-imports

# Pages with their examples run and their links looked up; a warning is an error.
docs: $(STAMP)
	$(BIN)/python -m pip install --quiet --group docs
	$(BIN)/sphinx-build --quiet --fail-on-warning --builder doctest docs build/docs/doctest
	$(BIN)/sphinx-build --quiet --fail-on-warning --builder linkcheck docs build/docs/links
	$(BIN)/sphinx-build --quiet --fail-on-warning --builder html docs build/docs/html

check: lint types layers docs test

$(STAMP): pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"
	$(BIN)/python -m pip install --quiet --editable ".$(if $(EXTRAS),[$(EXTRAS)])" --group dev
	touch $@

clean:
	rm -rf build dist $(VENV)
