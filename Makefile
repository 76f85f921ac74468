# make demo   the main job: install into .venv and run the 1992 program
# make test   the tests; prints their processor time by folder
# make test-ideal   the tests that need no MuJoCo
# make gates  layout, style, types, import contracts, copied code
# make campaign   the tests at full size, of which make test runs a sample (minutes)
# make format  the layout that the gates ask for
# make bench  the figures of docs/measured.md that are times or ratios of times
# make view-bench  what pages of runs cost: bytes, time, memory, and a frame while they play (needs chromium)
# make plots   the plots of docs/servo.md, drawn anew
# make fault-campaign         every injected fault and 200 clean runs, counted (minutes)
# make supervision-campaign   wrong payloads in random programs, counted
# make blend-campaign         2,000 random chains of moves with zones, counted (half an hour)
# make stop-campaign          chains stopped at random cycles, counted (minutes)
# make gcode-campaign         milling programs in G-code of the folder LINUXCNC_PROGRAMS, planned and compared (minutes)
# make jog-campaign           random jogs with held keys and stops, their logs checked (20 minutes)
# make pulse-campaign         random moves of four machines as pulse tables, counted
# make wrist-campaign         random straight moves through the wrist, counted (minutes)
# make fuzz               readers of programs, points, cells, arms and golden logs on made-up bytes, FUZZ_SECONDS of each target
# make verdict-campaign     do check and a run judge alike? 2,000 made-up programs with their files, counted
# make large              time and memory of check and fmt on programs of 1 MB of every kind (minutes)
# make mutants   mutants of supervision, stops, payload and areas: those that no test finds, and how many one finds (minutes)
# make figures  the pictures of README and docs, taken anew from runs
# make docs   the documentation as a site in out/site, checked for dead links
# make measured   the figures of docs/measured.md that repeat exactly
# make wheel-test   sdist and wheel, and the wheel in an environment of its own: every command, examples, a new project (a minute)
# make viewer   the script of the pages, built anew from robolang/view/page (needs node)
# make help   these lines

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

# A row that is not as promised ends a bench or a campaign with an error.

.PHONY: $(shell sed -n 's/^\([a-z-]*\):.*/\1/p' $(firstword $(MAKEFILE_LIST)))

demo: $(READY)
	$(BIN)/robolang run programs/pick_and_place.rbl

help:
	@sed -n 's/^# make/make/p' $(MAKEFILE_LIST)

test: $(READY)
	$(BIN)/python -m pytest -n auto --maxprocesses 4

test-ideal: $(READY)
	$(BIN)/python -m pytest -n auto --maxprocesses 4 -m "not physics"

campaign: $(READY)
	CAMPAIGN=1 $(BIN)/python -m pytest -n auto --maxprocesses 4

gates: $(READY)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/pylint --score=n robolang runtime

format: $(READY)
	$(BIN)/ruff format .
	$(BIN)/ruff check --select I --fix .

bench: $(READY)
	$(BIN)/python -m tests.bench.run
	$(BIN)/python -m tests.bench.inertia
	$(BIN)/python -m tests.bench.check
	$(BIN)/python -m tests.bench.prompt
	$(BIN)/python -m tests.bench.long_path

view-bench: $(READY)
	$(BIN)/python -m tests.bench.pages
	$(BIN)/python -m tests.bench.frames
	$(BIN)/python -m tests.bench.live

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; assert sys.version_info >= (3, 11), "Python 3.11 or newer is needed"'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $@

docs: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	$(BIN)/zensical build --clean --strict

measured: $(READY)
	$(BIN)/python -m tests.bench.measure
	$(BIN)/python -m tests.bench.short_moves

plots: $(READY)
	$(BIN)/python -m tests.bench.plots

figures: $(READY)
	$(BIN)/python -m tests.bench.pictures

fault-campaign: $(READY)
	$(BIN)/python -m tests.faults.campaign faults

supervision-campaign: $(READY)
	$(BIN)/python -m tests.faults.campaign payload

verdict-campaign: $(READY)
	$(BIN)/python -m tests.robolang.verdicts 2000

blend-campaign: $(READY)
	$(BIN)/python -m tests.bench.blend_campaign

stop-campaign: $(READY)
	$(BIN)/python -m tests.bench.stop_campaign

gcode-campaign: $(READY)
	$(BIN)/python -m tests.bench.gcode_campaign

jog-campaign: $(READY)
	$(BIN)/python -m tests.bench.jog_campaign

pulse-campaign: $(READY)
	$(BIN)/python -m tests.bench.pulse_campaign

wrist-campaign: $(READY)
	$(BIN)/python -m tests.bench.wrist_campaign

FUZZ_SECONDS ?= 60
FUZZ_TARGETS ?= lex parse check format points cell model mesh golden log

fuzz: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev,fuzz]'
	set -e; for target in $(FUZZ_TARGETS); do $(BIN)/python -m tests.fuzz.run $$target $(FUZZ_SECONDS); done

large: $(READY)
	$(BIN)/python -m tests.fuzz.large

mutants: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev,mutants]'
	rm -rf mutants
	$(BIN)/mutmut run
	$(BIN)/mutmut results
	$(BIN)/python -m tests.bench.mutants

wheel-test: $(READY)
	$(BIN)/python -m tests.wheel

viewer:
	cd robolang/view/page && npm ci --ignore-scripts --no-audit --no-fund && npx --no-install tsc --noEmit && node build.mjs

clean:
	rm -rf $(VENV) out mutants
