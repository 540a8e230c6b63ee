# SPDX-License-Identifier: Apache-2.0
# make playground       build/playground/index.html: the C++ models, compiled to WebAssembly, in a page without a server
# make playground-test  that page in headless Chromium beside `dtof frame`: every code and figure equal
.PHONY: playground playground-test

playground: | build_folder
	@scripts/install_packages.sh playground
	@scripts/build_playground.sh

playground-test: playground build
	@scripts/install_packages.sh playground browser
	@/usr/bin/python3 -B scripts/playground_test.py
