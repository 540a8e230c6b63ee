# SPDX-License-Identifier: Apache-2.0
# make test-sanitize  every C++ test under AddressSanitizer and UndefinedBehaviorSanitizer, the parallel ones under
#                     ThreadSanitizer (half an hour)
# make fuzz           readers and command line on damaged input, FUZZ_SECONDS (600) each of FUZZ_TARGETS (all, else
#                     names of tests/fuzz/corpus)
FUZZ_SECONDS ?= $(if $(SMALL),2,600)
FUZZ_TARGETS ?=
.PHONY: test-sanitize fuzz

test-sanitize: packages
	@scripts/sanitize.sh

fuzz:
	@scripts/install_packages.sh fuzz
	@FUZZ_SECONDS=$(FUZZ_SECONDS) scripts/fuzz.sh $(FUZZ_TARGETS)
