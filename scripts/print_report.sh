#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints the tables of the main job: those in build/, or the committed ones of reports/ if it has not run here.
set -euo pipefail
for report in frame tmf8820; do
  for folder in build reports; do
    if [ -f "$folder/$report/summary.md" ]; then
      printf '\n== %s\n\n' "$folder/$report"
      grep -v '^!\[' "$folder/$report/summary.md"  # pictures are for the page
      break
    fi
  done
done
