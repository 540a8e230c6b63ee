#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# C++ format; names and types in Python; what is written from readouts.toml; the engine's schedule; figures on README.md and docs/; the pictures
# under reports/; links and pages of the documents; RTL of every named configuration through Verilator -Wall, Yosys and Icarus Verilog.
# --quick leaves out the RTL, which takes two minutes; --rtl, behind a build of the tests, leaves out everything else, and of the RTL what
# scripts/lint_rtl.py --quick leaves out.
# --static-analysis adds clang-tidy over all C++ (half an hour).
set -euo pipefail
format_version=14  # of clang-format: Debian 12's

if [ "${1:-}" = "--rtl" ]; then
  exec /usr/bin/python3 scripts/lint_rtl.py --quick
fi

# The two longest of the quick checks run beside the others.
scripts/schedule.py --check & schedule=$!
scripts/check_types.py & types=$!

mapfile -t sources < <(scripts/list_files.py .cpp .hpp .c driver/dtof.h driver/dtof_access.h driver/dtof_filter.h examples/soc/software.h)
format=clang-format-$format_version
command -v "$format" > /dev/null || format=clang-format
installed=$("$format" --version | sed -nE 's/.*version ([0-9]+).*/\1/p')
if [ "$installed" = "$format_version" ]; then
  "$format" --dry-run --Werror "${sources[@]}"
  echo "clang-format: ${#sources[@]} files clean"
else
  echo "clang-format: skipped, for version $installed breaks lines otherwise than version $format_version, which the files follow"
fi

mapfile -t modules < <(scripts/list_files.py .py)
/usr/bin/python3 -m pyflakes "${modules[@]}"
echo "pyflakes: ${#modules[@]} files clean"

scripts/generate.py --check
echo "readouts.toml, registers.toml: everything written from them is up to date"

scripts/check_names.py
scripts/check_language.py
scripts/check_house.py
scripts/maturity.py --check
echo "docs/reference/maturity.md: the stages are those of the lists of files and proofs"

wait $types
wait $schedule
echo "engine's schedule: the page is that of the RTL"

scripts/update_readme.py --check
scripts/reports.py figures --check
echo "figures: README.md and docs/ show those of reports/figures.json, none is typed by hand, stale reports say that they are"

scripts/check_pictures.py
echo "reports/: few and small pictures, each shown by a document"

scripts/check_documents.py
echo "documents: every link resolves, every module has its section, which names what it has"

[ "${1:-}" != "--quick" ] || exit 0
/usr/bin/python3 scripts/lint_rtl.py

if [ "${1:-}" = "--static-analysis" ]; then
  mapfile -t units < <(scripts/list_files.py .cpp)
  if [ ! -d /usr/include/dlib ]; then  # the one library that only training needs (package purpose "learning")
    mapfile -t units < <(grep -L '<dlib/' "${units[@]}")
    echo "clang-tidy: without dlib, the files that use it are left out"
  fi
  cmake -S . -B build/tidy -G Ninja -DDTOF_UNITY=OFF -DCMAKE_CXX_FLAGS_RELEASE=-O2 > build/tidy.log 2>&1 || { cat build/tidy.log; exit 1; }
  printf '%s\n' "${units[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy --quiet -p build/tidy 2> build/clang_tidy.log \
    || { echo "clang-tidy found problems" >&2; exit 1; }
  echo "clang-tidy: ${#units[@]} files clean"
fi
