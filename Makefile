# Short names for `python tools/run.py …`; without make, call that directly (see README.md).
PYTHON ?= $(firstword $(foreach name,python3.11 python3.12 python3.13 python3 python,$(shell command -v $(name) 2>/dev/null)))
ARGS ?=

.PHONY: help book serve test check lint notebooks numbers chapters options replay clean
help book serve test check lint notebooks numbers chapters options replay clean:
	@$(if $(PYTHON),$(PYTHON) tools/run.py $@ $(ARGS),echo "[course] stopped: no Python found; install Python 3.11, 3.12 or 3.13" >&2; exit 1)
