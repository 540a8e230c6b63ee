# SPDX-License-Identifier: Apache-2.0
# make dist         source archive of the last commit, with its notes and checksums, in build/release
.PHONY: dist
dist:
	@scripts/release.py archive --out $(OUT)/release
