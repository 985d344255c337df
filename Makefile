# Every target makes .venv first, with everything in it, and never touches the system's Python. `make run` installs no
# more than it needs, which takes a third of the time; what is missing comes with the first other target.
PYTHON ?= python3
BIN := .venv/bin

.PHONY: help setup run test lint bench pictures reference lock clean faults busy fuzz soak undos coverage mutants try-llamacpp

help:
	@echo "make setup   .venv with everything in it        make run    talk to the simulated robot"
	@echo "make test    lint, types, layers, tests         make lint   ruff and mypy alone"
	@echo "make bench   how fast it is, measured           make lock   write requirements.lock anew"
	@echo "make pictures   draw docs/images anew, from the real program"
	@echo "make reference  write docs/cli.md and docs/events.md anew, from the code"
	@echo "make faults  kill and freeze each process 20 times; worst time to zero"
	@echo "make busy    200 motions beside 8 busy processes, and kills and freezes: BUSY='--motions 40 --busy 4'"
	@echo "make fuzz    a million sequences of 50 nasty commands at the governor: FUZZ='--sequences 1000 --seed 2'"
	@echo "make soak    100 sessions of 30 turns in two worlds: is the told pose the true one? SOAK='--real --busy 2 --seeds 10'"
	@echo "make undos   stop 20 plans at 20 moments each, undo them: how far from where each turn began?"
	@echo "make coverage   every branch of governor, reflex and the guard's rule, or it fails"
	@echo "make mutants    change the safety code in every way a tool can think of; the tests must notice"
	@echo "make try-llamacpp   build llama.cpp, make a tiny random model, let it drive the simulated robot"
	@echo "make clean   remove .venv and what tools left"

setup:
	@PYTHON="$(PYTHON)" scripts/setup.sh

run:
	@PYTHON="$(PYTHON)" scripts/setup.sh web,record
	@$(BIN)/chatrobot --web

lint: setup
	$(BIN)/ruff check src tests examples scripts bench ros
	$(BIN)/ruff format --check src tests examples scripts bench ros
	MYPY_NUM_WORKERS=2 $(BIN)/mypy

# Where no process may keep its bytecode, each compiles all of ours anew.
unexport PYTHONDONTWRITEBYTECODE

# Real processes in real time come after the rest, three at a time: they wait more than they work. Those that measure a
# promise come by themselves, two at a time; what keeps the machine busy on purpose comes last, alone. What fails is tried
# once more with nothing beside it: a busy machine may hold a process up once, but a promise that is broken twice is broken.
AGAIN := --last-failed --last-failed-no-failures none
# Looking through all other files costs each process five seconds; tests/conftest.py sees to it that none is missed.
REALTIME = $(filter-out tests/ros/%,$(shell grep -rl --include='test_*.py' 'mark\.realtime' tests)) tests/ros
BUSY := tests/nodes/test_busy_machine.py
# Python 3.11 cannot parse a source for pytest's own tracebacks where a browser is driven, and then no test goes on.
PLAIN := --tb=native
# What is chosen, how many at a time, and where it is looked for.
TWICE = $(BIN)/pytest $(1) $(2) $(PLAIN) $(3) || $(BIN)/pytest $(1) $(AGAIN) $(PLAIN) $(3)
test: lint
	$(BIN)/pytest -m "not realtime" -n 3
	$(call TWICE,-m "realtime and not alone",-n 3 --dist loadfile,$(REALTIME))
	$(call TWICE,-m alone,-n 2 --dist loadfile,$(filter-out $(BUSY),$(REALTIME)))
	$(call TWICE,-m alone,,$(BUSY))

bench: setup
	@for file in bench/[a-z]*.py; do \
		echo "== $$file"; $(BIN)/python -m "bench.$$(basename "$$file" .py)" || exit 1; done

# Twenty blows of each kind in real time: about three quarters of an hour.
faults: setup
	$(BIN)/python -m scripts.faults

# About a quarter of an hour.
busy: setup
	$(BIN)/python -m scripts.busy $(BUSY)

# A million sequences take about twenty minutes on two cores.
fuzz: setup
	$(BIN)/python -m scripts.fuzz $(FUZZ)

# A few minutes in simulated time; in real time about four minutes a session.
soak: setup
	$(BIN)/python -m scripts.soak $(SOAK)

undos: setup
	$(BIN)/python -m scripts.undos $(UNDOS)

coverage: setup
	$(BIN)/coverage run -m pytest -q -m "not realtime and not slow" \
		tests/governor tests/guard tests/reflex tests/safety
	$(BIN)/coverage report

# About ten minutes on two cores.
mutants: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[mutants]'
	rm -rf mutants
	$(BIN)/python -m scripts.mutants

# Needs DejaVu Sans Mono, a font with Chinese, and Chromium on the system.
pictures: setup
	$(BIN)/python scripts/make_pictures.py
	$(BIN)/python -m scripts.make_web_pictures

reference: setup
	$(BIN)/python -m scripts.make_reference

# Builds for about five minutes the first time.
try-llamacpp: setup
	test -d .venv-llamacpp || $(PYTHON) -m venv .venv-llamacpp
	.venv-llamacpp/bin/python -m pip install --quiet --disable-pip-version-check 'llama-cpp-python[server]' gguf
	$(BIN)/python -m scripts.try_llamacpp .venv-llamacpp/bin/python

lock: setup
	$(BIN)/python scripts/lock.py

clean:
	rm -rf mutants .coverage .venv .venv-llamacpp .mypy_cache .ruff_cache .pytest_cache .hypothesis build dist
