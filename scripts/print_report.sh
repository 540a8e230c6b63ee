#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints the tables of reports/ that this tree's commands wrote, one after the other.
set -euo pipefail
for report in frame tmf8820; do
  if [ -f "reports/$report/summary.md" ]; then
    printf '\n== reports/%s\n\n' "$report"
    cat "reports/$report/summary.md"
  fi
done
