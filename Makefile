# SPDX-License-Identifier: Apache-2.0
# make help       this list in groups, with minutes
# make all        install what is missing, build, read one scene out through the RTL of every read-out, report (make alone does the same)
# make test       every test and the lint; LINTED=1: make quick has run
# make sim        the main job without the installation step
# make report     build/report/index.html, all results on a page, and the main job's tables; make publish: reports/ has them
# make study      one study, by NAME=scenes; make study-program: the program that most of them run
# make synth      area, timing and power of every configuration; make sim-netlist, sim-icarus: simulated beside the RTL
# make power      power from the activity of netlists on a scene
# make layout     columns placed and routed in OSU 0.18 um, checked, with GDS; make orfs: files for OpenROAD (synth/layout.mk)
# make quick      what takes seconds: format, types, generated files, documents, stale figures
# make try-targets  every target on little work, in a copy of the last commit: what is broken (scripts/try_targets.py)
# make lint       RTL in three tools, C++ format and static analysis; make lint-slang: RTL in slang, a strict front end from npm
# make formal     proofs of the RTL (25 minutes)
# make coverage   what the tests reach (scripts/faults.mk)
# make wave       READOUT's waveform; make full: dtof with subsystems and the RTL of poolPointer (scripts/wave.mk)
# make fpga-check what a small subsystem takes on four FPGA families, by Yosys (scripts/fpga.mk)
# make fpga       a demonstrator for an iCE40: bitstream, utilisation, its netlist simulated (scripts/fpga.mk)
# make shuttle    a chip in IHP's open 130 nm process: netlist, timing in three corners, inputs of two layout flows (synth/shuttle.mk)
# make random-configurations, random-subsystems  N=30 arrays, N=12 subsystems of drawn parameters beside their models (scripts/random.mk)
# make example    a frame of dtof_subsystem in a small SystemVerilog bench (scripts/example.mk)
# make bench      speed of RTL, models and photon model; SMALL=1: each once, on less work
# make test-sanitize, make fuzz: the tests under sanitizers; readers and command line on damaged input (scripts/hostile.mk)
# make cases      every case that outsiders reported, of ../shared/cases (scripts/cases.mk)
# make test-adding the worked example of docs/user/adding_a_readout.md, in a fresh clone (scripts/adding.mk)
# make playground the C++ models in a page (scripts/playground.mk)
# make mutate     small changes of RTL, models and synthesis flow: which of them the tests notice (long)
# make figures    measured figures into README.md and docs/; make stale, make reports: what is old, renewed (scripts/reports.mk)
# make clean      remove build/
ifneq ($(words $(CURDIR)),1)
$(error The folder '$(CURDIR)' has a blank in its path, which Make and Verilator cannot handle: move the project)
endif

BUILD := build/cpp
# SMALL=1: the same steps on less work, whose results lie in build/small and never in reports/ (scripts/figures/small.py)
WRITTEN_ROOT := $(if $(SMALL),build/small/)
OUT := $(WRITTEN_ROOT)build
REPORTS := $(WRITTEN_ROOT)reports
SEED ?= 1
SHARED_DATA ?= ../shared/data
DTOF := $(BUILD)/bin/dtof
DTOF_STUDY := $(BUILD)/bin/dtof-study

.DEFAULT_GOAL := all
.PHONY: all help packages configure build study study-program sim report publish test quick try-targets lint lint-slang bench clean

all: packages sim
	@$(MAKE) --no-print-directory report

packages:
	@scripts/install_packages.sh

configure: packages | build_folder
	@# A folder that was moved or copied has the cache of another one.
	@configured=$$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' $(BUILD)/CMakeCache.txt 2> /dev/null); \
	  [ -z "$$configured" ] || [ "$$configured" -ef . ] || fresh=--fresh; \
	  cmake $$fresh -S . --preset release > $(BUILD).log 2>&1 || { cat $(BUILD).log; exit 1; }

build: configure
	@ninja -C $(BUILD) dtof

study-program: configure
	@ninja -C $(BUILD) dtof-study

study:
	@name=$$(scripts/help.py --study "$(NAME)") && $(MAKE) --no-print-directory "$$name"

help:
	@scripts/help.py $(if $(ALL),--all)

build_folder:
	@mkdir -p build

sim: build
	@SEED=$(SEED) SHARED_DATA=$(SHARED_DATA) scripts/simulate.sh $(DTOF)

report: packages
	@scripts/report_page.py
	@scripts/print_report.sh

publish:
	@scripts/publish.py frame $(if $(wildcard $(OUT)/tmf8820/summary.md),tmf8820)

test: configure
	@scripts/install_packages.sh browser python clang
	@$(if $(LINTED),,scripts/lint.sh --quick)
	@ninja -C $(BUILD)
	@scripts/lint.sh --rtl
	@scripts/run_tests.sh $(BUILD)

# What takes seconds: format, generated files, documents, stale figures, beside each other.
quick: configure
	@scripts/reports.py stale-check & stale=$$!; scripts/lint.sh --quick && wait $$stale

# TARGETS="sim claims": some; OPTIONS=--quick, --again: scripts/try_targets.py --help
try-targets:
	@scripts/try_targets.py $(OPTIONS) $(TARGETS)

lint: configure
	@scripts/install_packages.sh lint
	@scripts/lint.sh --static-analysis

lint-slang: | build_folder
	@command -v npm > /dev/null || scripts/install_packages.sh slang
	@scripts/slang.py --install

bench: configure
	@ninja -C $(BUILD) rtl_bench photon_bench
	@$(BUILD)/bin/rtl_bench $(if $(SMALL),--small)
	@$(BUILD)/bin/photon_bench $(if $(SMALL),--small)

clean:
	rm -rf build

include synth/synth.mk
include synth/layout.mk
include synth/shuttle.mk
include scripts/reproduce.mk
include scripts/coverage_study.mk
include scripts/photon_report.mk
include scripts/study.mk
include scripts/enlarge.mk
include scripts/formal.mk
include scripts/faults.mk
include scripts/sensor_effects.mk
include scripts/mutate.mk
include scripts/hostile.mk
include scripts/cases.mk
include scripts/adding.mk
include scripts/playground.mk
include scripts/wave.mk
include scripts/random.mk
include scripts/example.mk
include scripts/products.mk
include scripts/fpga.mk
include scripts/sweep.mk
include scripts/reports.mk
include scripts/release.mk
