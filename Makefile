# The commands a person uses. Everything is installed into .venv; FMUs are built into build/.
PYTHON ?= python3
BIN := .venv/bin
export PATH := $(CURDIR)/$(BIN):$(PATH)

.PHONY: demo test check bench fuzz build clean

demo: build                     ## build all and run the demo scenario
	$(BIN)/motionfmu run scenarios/circle

build: .venv/installed
	@test -f build/build.ninja || cmake --preset default -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python > /dev/null
	@cmake --build build

test: build check               ## everything: style, C tests (also sanitized), Python tests
	@ctest --test-dir build -j 2 --output-on-failure
	@test -f build/asan/build.ninja || cmake --preset asan -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python > /dev/null
	@cmake --build build/asan
	@ctest --test-dir build/asan -j 2 --output-on-failure
	$(BIN)/python -m pytest -n 2 --dist loadgroup

check: .venv/installed          ## formatting, lint, types
	$(BIN)/ruff format --check src tests scenarios
	$(BIN)/ruff check src tests scenarios
	$(BIN)/mypy

bench: build                    ## speed, as ratios measured in one run
	@cmake --build build --target fused card_cost interpreter_cost kinematics_cost lookahead_cost scurve_batch
	PYTHONPATH=tests $(BIN)/python tests/bench/bench.py

SECONDS ?= 120
fuzz: .venv/installed           ## every tests/fuzz/fuzz_*.c on inputs at random, SECONDS each
	tests/fuzz/run.sh $(SECONDS)
	MOTIONFMU_FUZZ=$(SECONDS) $(BIN)/python -m pytest -n 2 tests/house/test_fuzz_readers.py

clean:
	rm -rf build results

.venv/installed: pyproject.toml Makefile
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	@echo "Installing the Python packages into .venv (once, about a minute) ..."
	@$(BIN)/python -c "import tomllib; p = tomllib.load(open('pyproject.toml', 'rb'))['project']; \
	  print(*p['dependencies'], *p['optional-dependencies']['dev'], sep='\n')" > .venv/requirements.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check -r .venv/requirements.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check --no-deps --no-build-isolation \
	  -C wheel.cmake=false -C editable.mode=inplace -e .
	@touch $@
