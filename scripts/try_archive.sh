#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs commands on the files of the last commit where no git repository is, as somebody does who unpacks the source archive:
#   try_archive.sh [COMMAND]...   by default 'make' and 'make test'
# The folder is a new one in TMPDIR (/tmp) and removed at the end; a log of each command is left in build/archive.
set -euo pipefail
cd "$(dirname "$0")/.."
logs=$PWD/build/archive
mkdir -p "$logs"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
git archive --prefix=dtof-readout/ HEAD | tar -x -C "$folder"
echo "archive: $(git log -1 --format='commit %h, %s')"
export GIT_CEILING_DIRECTORIES=$folder
unset GIT_DIR GIT_WORK_TREE
cd "$folder/dtof-readout"
if git rev-parse --git-dir > /dev/null 2>&1; then
  echo "error: $folder is in a git repository: set TMPDIR to a folder that is not" >&2
  exit 1
fi

[ $# -gt 0 ] || set -- make "make test"
for command in "$@"; do
  name=$(printf '%s' "$command" | tr -cs '[:alnum:]' _ | cut -c 1-40)
  log=$logs/${name%_}.log
  begin=$SECONDS
  if sh -c "$command" > "$log" 2>&1 < /dev/null; then
    echo "archive: $command passed in $((SECONDS - begin)) s"
  else
    tail -n 20 "$log" >&2
    echo "error: archive: $command failed after $((SECONDS - begin)) s (log: $log)" >&2
    exit 1
  fi
done
