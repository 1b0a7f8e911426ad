# The commands a person uses. Everything is installed into .venv; FMUs are built into build/.
PYTHON ?= python3
BIN := .venv/bin
export PATH := $(CURDIR)/$(BIN):$(PATH)
# Byte code is kept, whatever the environment says: tests start Python some hundred times, and reading the packages
# anew takes each of them one to three seconds more.
export PYTHONDONTWRITEBYTECODE :=

# What is needed beforehand is said before anything is made. The program is one that any Python reads.
NEEDS := import sys; v = sys.version_info; \
  sys.exit(None if v >= (3, 11) else "%s is Python %d.%d, 3.11 or newer is needed: make PYTHON=..." % ((sys.executable,) + tuple(v[:2])))
VENV := import ensurepip, venv
# In a log a build tells what is wrong; on a terminal, how far it is, too.
QUIET := $(if $(MAKE_TERMOUT),,-- --quiet)

.NOTPARALLEL: # ninja, ctest and pytest share out the cores
.PHONY: needs demo test test-more test-all test-long sanitized check bench importers warnings fuzz explore mutants build export wheel docs clean

demo: build                     ## build all and run the demo scenario
	$(BIN)/motionfmu run scenarios/circle

needs:
	@command -v $(CC) > /dev/null || { echo "There is no C compiler $(CC): install gcc, or make CC=..." >&2; exit 1; }
	@p=$(BIN)/python; test -x $$p || p=$(PYTHON); \
	  command -v $$p > /dev/null || { echo "There is no $$p: Python 3.11 or newer is needed, or make PYTHON=..." >&2; exit 1; }; \
	  $$p -c '$(NEEDS)' || exit 1; \
	  test -x $(BIN)/python || $$p -c '$(VENV)' 2> /dev/null || { echo "$$p has no venv: install it (Debian: python3-venv)" >&2; exit 1; }

build: needs .venv/installed
	@test -f build/build.ninja || cmake --preset default -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python > /dev/null
	@cmake --build build $(QUIET)

export: needs .venv/exporting    ## FMUs for Linux, Windows and macOS in build/export/fmus
	@grep -qs MOTIONFMU_EXPORT:BOOL=ON build/CMakeCache.txt || cmake --preset export -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python > /dev/null
	@cmake --build build --target export $(QUIET)

wheel: build export             ## the wheel for pip in build/wheel, tried in a new environment
	$(BIN)/python tests/helpers/wheel_making.py build/export build/wheel

docs: build .venv/documenting    ## the site in build/site, which opens from disk; its warnings are errors
	@$(BIN)/python docs/site/build.py build/site > build/site.txt 2>&1 || { grep -E "WARNING|ERROR|rror:" build/site.txt; exit 1; }
	@echo build/site/index.html

# Nothing of one test run is repeated by the next: test, test-more and test-long have no test in common.
PYTEST = $(BIN)/python -m pytest -n 2 --dist loadgroup --durations=25
# C tests of a build; those that hold are told in its tests.txt alone.
CTEST = ctest --test-dir $(1) -j 2 --output-on-failure > $(1)/tests.txt || { grep -v -e " Passed " -e " Start " $(1)/tests.txt; \
  echo "C tests failed in $(1)" >&2; exit 1; }; grep "tests passed" $(1)/tests.txt

test: build                     ## what every change needs: style, C tests, most Python tests
	@{ $(call CTEST,build); } & tested=$$!; $(MAKE) --no-print-directory check; checked=$$?; wait $$tested && exit $$checked
	$(PYTEST) --durations-min=5

test-more: build export sanitized .venv/documenting    ## what is slow and stands by itself: sanitized C tests, exports, tests marked `more`
	@$(call CTEST,build/asan)
	MOTIONFMU_SKIPS=listed $(PYTEST) -m "more and not long" --durations-min=20

test-all: export MOTIONFMU_SKIPS = listed
test-all: test test-more        ## everything but test-long; a skip that is not in tests/skips.toml is an error

test-long: build                ## what takes two hours and the others show of a few: FMPy on all scenarios
	$(PYTEST) -m long --durations-min=60

sanitized: build                ## C tests and fuzz harnesses with AddressSanitizer and UBSan in build/asan
	@test -f build/asan/build.ninja || cmake --preset asan -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python > /dev/null
	@cmake --build build/asan $(QUIET)

check: needs .venv/installed          ## formatting, lint, types, plain sentences
	git ls-files '*.c' '*.h' '*.inc' | xargs $(BIN)/clang-format --dry-run --Werror
	$(BIN)/ruff format --check src tests scenarios docs
	$(BIN)/ruff check src tests scenarios docs
	$(BIN)/mypy
	$(BIN)/python tests/helpers/plain_english.py

bench: build                    ## speed, as ratios measured in one run; BENCH=--renew keeps its figures, --profile counts by part, --cluster takes a study on dask
	@cmake --build build --target fused_circle fused_six_axes fused_profiled count_here card_cost interpreter_cost kinematics_cost lookahead_cost scurve_batch
	PYTHONPATH=tests/helpers $(BIN)/python tests/bench/bench.py $(BENCH)

importers: build export         ## FMUs in other people's importers, which it installs; writes docs/importers.md
	PYTHONPATH=tests/importers $(BIN)/python tests/importers/matrix.py

warnings: build                 ## every C file by other compilers, whose warnings are errors
	$(BIN)/python tests/ports/warnings.py build

SECONDS ?= 120
fuzz: needs .venv/installed           ## every tests/fuzz/fuzz_*.c on inputs at random, SECONDS each
	tests/fuzz/run.sh $(SECONDS)
	MOTIONFMU_FUZZ=$(SECONDS) $(BIN)/python -m pytest -n 2 tests/house/test_fuzz_readers.py

explore: build                  ## property tests on fresh inputs for SECONDS; what fails is kept in build/explore
	$(BIN)/python tests/explore.py $(SECONDS)

mutants: build                  ## one line changed at a time, the nearest tests; MUTANTS="--count 100 --only src/controllers/robot"
	$(BIN)/python tests/mutants/mutants.py $(MUTANTS)

clean:
	rm -rf build results

.venv/installed: pyproject.toml Makefile | needs
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	@echo "Installing the Python packages into .venv (once, about a minute) ..."
	@$(BIN)/python -c "import tomllib; p = tomllib.load(open('pyproject.toml', 'rb'))['project']; more = p['optional-dependencies']; \
	  print(*p['dependencies'], *(r for name in more if name != 'export' for r in more[name]), sep='\n')" > .venv/requirements.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check -r .venv/requirements.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check --no-deps --no-build-isolation \
	  -C wheel.cmake=false -C editable.mode=inplace -e .
	@touch $@

# What cross-compiles takes 400 MB, and only exports need it.
.venv/exporting: .venv/installed
	@echo "Installing the compiler for other platforms into .venv (once) ..."
	@$(BIN)/python -c "import tomllib; p = tomllib.load(open('pyproject.toml', 'rb'))['project']; \
	  print(*p['optional-dependencies']['export'], sep='\n')" > .venv/exporting.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check -r .venv/exporting.txt
	@touch $@

# Only the site needs Sphinx.
.venv/documenting: .venv/installed
	@echo "Installing Sphinx into .venv (once) ..."
	@$(BIN)/python -c "import tomllib; print(*tomllib.load(open('pyproject.toml', 'rb'))['dependency-groups']['docs'], sep='\n')" > .venv/documenting.txt
	@$(BIN)/python -m pip install --no-compile --quiet --disable-pip-version-check -r .venv/documenting.txt
	@touch $@
