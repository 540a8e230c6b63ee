# SPDX-License-Identifier: Apache-2.0
# make test-adding    adds the read-out of docs/user/adding_a_readout.md to a fresh clone of the last commit in
#                     build/adding_a_readout, tests and synthesises it there (JOBS=2: so many at a time)
.PHONY: test-adding
test-adding: packages
	@scripts/check_adding_a_readout.sh
