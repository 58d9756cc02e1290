# `make` alone lists what there is to make. Nothing but Python 3.11 and make is needed beforehand.

PYTHON ?= $(shell command -v python3.11 || command -v python3)
BIN := .venv/bin
FEEDER := $(BIN)/feeder
READY := .venv/.ready
READY_TO_TEST := .venv/.ready-to-test
DEMO := lbracket_30x20x15
BOLT := hexbolt_m8x25

PARTS := $(wildcard parts/*.stl)
CARDS := $(wildcard parts/*.yaml)
CONFIGS := $(wildcard configs/*.yaml)
NAMES := $(basename $(notdir $(PARTS)))

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.SUFFIXES:
.PHONY: help demo test check test-lowest test-newest test-without lint format all-aspects inertia maps bench mutants docs site wheels release fuzz clean distclean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

# The steps compile what the main job needs: the kernels of drops, of the plate, of the trial and of conveying.
# The last lines go to stderr, behind the remarks of the steps.
demo: $(READY) ## a bolt: how it lies, the devices that let one way up leave, tried, and the bowl for 30 a minute
	$(FEEDER) aspects parts/$(BOLT).stl -o results
	$(FEEDER) tooling parts/$(BOLT).stl --aspect A -o results
	$(FEEDER) bowl parts/$(BOLT).stl --target 30/min --aspect A --config results/$(BOLT)/tooling.yaml -o results
	@{ echo; \
	   echo "The devices that let one way up of the bolt leave, and the bowl for 30 a minute. Pictures:"; \
	   ls results/$(BOLT)/*.png; \
	   echo; \
	   echo "The main job, from a part and a rate to a bowl that feeds it:"; \
	   echo "  $(FEEDER) design parts/$(BOLT).stl --target 30/min -o results"; } >&2

# Bytecode is kept where Python is told not to: without it each process of the suite compiles what it imports.
test: lint ## format, lint, types and every test, warnings as errors
	PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n 2 --dist worksteal

check: test ## the same, as CI runs it first

# What takes long is left out here: it asks more of the processor, and nothing more of the libraries.
SHORT := -m "not long and not thorough" -n 2 --dist worksteal

# Old libraries warn of what newer ones beside them will no longer take: nothing of ours.
test-lowest: ## the shorter tests with the lowest versions that pyproject.toml allows, in .venv-lowest
	$(PYTHON) -m venv --clear .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check uv
	.venv-lowest/bin/uv pip install --quiet --python .venv-lowest/bin/python --resolution lowest-direct --editable '.[test]'
	NUMBA_CACHE_DIR=$(CURDIR)/.venv-lowest/numba .venv-lowest/bin/python -m pytest $(SHORT) -W ignore::DeprecationWarning $(TESTS)

PLACES := $(filter-out %/shims,$(subst :, ,$(PATH))) $(wildcard $(HOME)/.pyenv/versions/*/bin)
NEWEST ?= $(shell ls $(PLACES:%=%/python3.??) 2> /dev/null | awk -F / '{ print $$NF, $$0 }' | sort -V | tail -n 1 | cut -d ' ' -f 2)

test-newest: ## the shorter tests with the newest Python and libraries there are, in .venv-newest
	$(NEWEST) -m venv --clear .venv-newest
	.venv-newest/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	NUMBA_CACHE_DIR=$(CURDIR)/.venv-newest/numba .venv-newest/bin/python -m pytest $(SHORT) $(TESTS)

WITHOUT := lxml networkx cascadio distributed jsonschema OCP pinocchio chromium prusa-slicer

test-without: $(READY_TO_TEST) ## the shorter tests with each extra missing in turn: WITHOUT="lxml OCP" names fewer
	for name in $(WITHOUT); do echo "without $$name"; PYTHONPATH=$(CURDIR)/tests/without TESTS_WITHOUT=$$name \
	  $(BIN)/python -m pytest $(SHORT) $(TESTS) || exit 1; done

lint: $(READY_TO_TEST) ## format, lint and types, nothing changed
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/python -m mypy -n 2

format: $(READY_TO_TEST) ## put the code into the house format
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

# A user's own Makefile can drive the tool with these rules as they stand: one part or bowl file,
# one folder of results, and only what is older than its file is made again.

all-aspects: $(NAMES:%=results/%/aspects.csv) $(CARDS:parts/%.yaml=results/%/aspects.csv) ## aspects of every part in parts/

inertia: $(NAMES:%=results/%/inertia.csv) ## mass properties of every mesh in parts/

maps: $(CONFIGS:configs/%.yaml=results/%/slide.csv) ## sliding maps of every bowl in configs/

results/%/aspects.csv: parts/%.stl | $(READY)
	$(FEEDER) aspects $< -o results --quiet > /dev/null

results/%/aspects.csv: parts/%.yaml | $(READY)
	$(FEEDER) aspects $< -o results --quiet > /dev/null

results/%/inertia.csv: parts/%.stl | $(READY)
	$(FEEDER) inertia $< -o results --quiet > /dev/null

results/%/slide.csv: configs/%.yaml | $(READY)
	$(FEEDER) slide --config $< -o results --quiet > /dev/null

TABLES := waits scale kernels
BENCHES := conveying speed tooling

bench: $(READY_TO_TEST) ## what people wait for, how it grows, and the kernels, about an hour: the tables of docs/speed.md
	for name in $(TABLES); do $(BIN)/python benchmarks/$$name.py --write || exit 1; done
	for name in $(BENCHES); do $(BIN)/python benchmarks/$$name.py || exit 1; done
	$(BIN)/python benchmarks/aspects.py --repeats 1

PICTURES := aspects regimes drop bowl bowl_solid design design_page serve tooling trial report conveying_map glossary_part glossary_track glossary_chain

docs: $(PICTURES:%=docs/%.png) docs/trial_film.gif $(READY) ## pictures, outputs and tables of the pages
	$(BIN)/python docs/readme.py
	$(BIN)/python docs/commands.py
	$(BIN)/python docs/equations.py
	$(BIN)/python docs/rules.py
	$(BIN)/python docs/bowl_file.py
	$(BIN)/python docs/columns.py
	$(BIN)/python docs/validation.py
	$(BIN)/python docs/designs.py

docs/aspects.png: results/$(DEMO)/aspects.csv
	cp results/$(DEMO)/aspects.png $@

docs/regimes.png: results/bowl/slide.csv
	cp results/bowl/slide_regimes_*.png $@

docs/drop.png: parts/$(BOLT).stl | $(READY)
	$(FEEDER) drop $< --drops 1000 --trace 1 -o results --quiet > /dev/null
	cp results/$(BOLT)/drop_trace.png $@

docs/bowl.png: parts/$(DEMO).stl | $(READY)
	$(FEEDER) bowl $< --target 60/min -o results --quiet > /dev/null
	cp results/$(DEMO)/bowl.png $@

docs/bowl_solid.png: parts/$(BOLT).stl docs/bowl_solid.yaml | $(READY)
	$(FEEDER) bowl $< --target 60/min --config docs/bowl_solid.yaml --solid -o results --quiet > /dev/null
	cp results/$(BOLT)/bowl_solid.png $@

mutants: $(READY_TO_TEST) ## small changes to the physics that no test notices, half an hour
	$(BIN)/python benchmarks/mutants.py

docs/tooling.png: docs/design.png
	cp results/$(BOLT)/tooling.png $@

docs/trial.png: parts/$(DEMO).stl docs/measured/example/bowl.yaml | $(READY)
	$(FEEDER) trial $< --config docs/measured/example/bowl.yaml --parts 24 -o results --quiet > /dev/null
	cp results/$(DEMO)/trial_stills.png $@

docs/trial_film.gif: parts/$(DEMO).stl docs/measured/example/bowl.yaml | $(READY)
	$(FEEDER) trial $< --config docs/measured/example/bowl.yaml --aspect A --parts 12 --queue 10 --seconds 25 --film $@ --quiet > /dev/null

docs/design.png: parts/$(BOLT).stl | $(READY)
	$(FEEDER) tooling $< --aspect A -o results --quiet > /dev/null
	cp results/$(BOLT)/tooling_3d.png $@

docs/design_page.png: parts/$(BOLT).stl docs/screenshot.py | $(READY_TO_TEST)
	$(FEEDER) design $< --target 30/min -o results --quiet > /dev/null
	$(BIN)/python docs/screenshot.py results/$(BOLT)/design.html $@

docs/serve.png: parts/$(BOLT).stl docs/serve_picture.py docs/screenshot.py | $(READY_TO_TEST)
	$(BIN)/python docs/serve_picture.py $< $@

docs/report.png: parts/$(DEMO).stl docs/screenshot.py | $(READY)
	$(FEEDER) report $< --config configs/bowl.yaml -o results --quiet > /dev/null
	$(BIN)/python docs/screenshot.py results/$(DEMO)/report.html $@

docs/conveying_map.png: docs/conveying_map.py | $(READY)
	$(BIN)/python docs/conveying_map.py

docs/glossary_part.png docs/glossary_track.png docs/glossary_chain.png &: docs/glossary.py | $(READY)
	$(BIN)/python docs/glossary.py

# Its own environment: mkdocs and its theme are needed for nothing else. site/ needs no server and no network.
site: $(READY) ## the pages as a site in site/, with search, API pages and a gallery that is made anew
	$(PYTHON) -m venv .venv-site
	.venv-site/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	NO_MKDOCS_2_WARNING=1 .venv-site/bin/python -m mkdocs build --quiet --strict

wheels: ## sdist and wheel in dist/, tried in fresh environments on each Python at hand
	$(PYTHON) docs/release.py --build

release: ## what a release is, step by step; checks, builds, tries and tags it
	@$(PYTHON) docs/release.py --tag

fuzz: $(READY_TO_TEST) ## 2,000 round bodies, then ten minutes of damaged files, on from where the last run stopped
	PYTHONPATH=tests:tests/support $(BIN)/python -m fuzz.rounds 2000
	PYTHONPATH=tests:tests/support $(BIN)/python -m fuzz 600

clean: ## remove results and caches
	rm -rf results build dist site .pytest_cache .ruff_cache .mypy_cache .hypothesis

distclean: clean ## remove .venv as well
	rm -rf .venv .venv-lowest .venv-newest .venv-site *.egg-info

# Bytecode is made on all cores, but for what nothing imports: pip makes all of it on one, half of its time.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
BYTECODE := $(BIN)/python -m compileall -qq -j 0 -x '/(tests|mypyc?|lexers)/' .venv/lib || true

$(READY): pyproject.toml
	$(PYTHON) -m venv .venv
	$(INSTALL) --editable .
	$(BYTECODE)
	touch $@

$(READY_TO_TEST): pyproject.toml
	$(PYTHON) -m venv .venv
	$(INSTALL) --editable '.[test]'
	$(BYTECODE)
	touch $(READY) $@
