# SPDX-License-Identifier: Apache-2.0
# make dist         source archive of the last commit, with its notes and checksums, in build/release
# make install      dtof and dtof-study with their man pages and completions for bash, into PREFIX (/usr/local)
.PHONY: dist install
PREFIX ?= /usr/local
dist:
	@scripts/release.py archive --out $(OUT)/release

install: build study-program
	@cmake --install $(BUILD) --component programs --prefix "$(PREFIX)" > /dev/null
	@echo "$(PREFIX): bin/, share/man/man1/ and share/bash-completion/completions/ of dtof and dtof-study"
