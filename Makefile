# What you can ask for; `make help` prints the lines that begin with two hashes.
#
# The build itself is CMake's (CMakeLists.txt); this file only gives the usual requests short names.
# Needs make, which a bare Debian lacks: apt-get install make

BUILD  ?= build
PREFIX ?= /usr/local
CMAKE  = cmake -S . -G Ninja
SECONDS ?= 120

.DEFAULT_GOAL := all
.PHONY: all help run test check-all bench install docs docs-check fuzz deps clean

## make                   build the libraries and the command in build/
all: $(BUILD)/build.ninja
	cmake --build $(BUILD) --target asperity_command

## make run               install what is missing, build, fit a fabricated measurement, draw a report
## make run DATA=file     the same for a measurement of yours: MERL, RGL or CSV
run:
	@scripts/install-deps.sh run
	@$(MAKE) --no-print-directory all
	@mkdir -p out
	$(BUILD)/asperity fit $(if $(DATA),'$(DATA)',--fabricate) -o out/report
	@echo 'Open $(CURDIR)/out/report/report.html in a browser.'

## make test              install what is missing, build twice (as shipped, with sanitizers), run all tests
test:
	@scripts/install-deps.sh test
	@BUILD='$(BUILD)' scripts/test.sh

## make check-all         the same with the long tests, and the fuzzers for SECONDS=120 each
check-all:
	@scripts/install-deps.sh test
	@scripts/fuzz.sh $(SECONDS)
	@BUILD='$(BUILD)' ASPERITY_LONG=1 scripts/test.sh

## make bench             speed beside a hand-written kernel and beside published figures; out/bench.json
bench:
	@scripts/install-deps.sh run
	@$(CMAKE) -B $(BUILD) -DASPERITY_BENCH=ON >/dev/null
	cmake --build $(BUILD) --target bench
	@mkdir -p out
	$(BUILD)/bench/bench -o out/bench.json

## make install PREFIX=/usr/local    libraries, headers, pkg-config and CMake packages, the command
install: all
	cmake --install $(BUILD) --prefix '$(PREFIX)'

## make docs              write again every page, table and picture that a command produces
docs: all
	scripts/docs.sh

## make docs-check        fail and show the difference when one of them is stale
docs-check: all
	scripts/docs.sh --check

## make fuzz              feed mutated files to every reader for SECONDS=120 each
fuzz:
	@scripts/install-deps.sh test
	@scripts/fuzz.sh $(SECONDS)

## make deps              only install what the tests need
deps:
	@scripts/install-deps.sh test

## make clean             remove what was built
clean:
	rm -rf $(BUILD) $(BUILD)-sanitize out

help:
	@sed -n 's/^## //p' Makefile

$(BUILD)/build.ninja: CMakeLists.txt
	@command -v cmake >/dev/null && command -v ninja >/dev/null || \
	    { echo 'cmake or ninja is missing: scripts/install-deps.sh run'; exit 1; }
	@$(CMAKE) -B $(BUILD) >$(BUILD).log || { cat $(BUILD).log; rm -f $(BUILD).log; exit 1; }
	@rm -f $(BUILD).log
