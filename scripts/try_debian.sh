#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the two commands of README.md in a fresh Debian: try_debian.sh SUITE [--folder FOLDER] [--run COMMAND]...
#   SUITE      bookworm (Debian 12) or trixie (Debian 13)
#   --folder   where the Debian system lies (build/debian/SUITE)
#   --run      this command, in the project's folder, instead of 'make' and 'make test'; may be given several times
# The system is made once by debootstrap and used again by the next run, with its packages, its build folder and its ccache;
# remove FOLDER to begin anew. The project in it is always the last commit. Logs: FOLDER.COMMAND.log, with the command's blanks as _;
# a command replaces its log of the run before. DEBIAN_MIRROR names another mirror than deb.debian.org. Needs root, because of chroot and mount.
# Everything that the commands start ends with them: they run in namespaces of their own.
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
  echo "error: $1" >&2
  exit "${2:-1}"
}

suite=${1:-}
case $suite in
  bookworm | trixie) shift ;;
  *) fail "the first argument is the suite, bookworm or trixie, and not '$suite'" 2 ;;
esac
folder=build/debian/$suite
commands=()
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || fail "$1 needs a value" 2
  case $1 in
    --folder) folder=$2 ;;
    --run) commands+=("$2") ;;
    *) fail "unknown option $1" 2 ;;
  esac
  shift 2
done
[ ${#commands[@]} -gt 0 ] || commands=(make "make test")

[ "$(id -u)" -eq 0 ] || fail "chroot and mount need root: run this script as root or with sudo"
for program in debootstrap unshare chroot git; do
  command -v "$program" > /dev/null || fail "$program is missing: apt-get install debootstrap util-linux coreutils git"
done
mkdir -p "$folder"
folder=$(realpath "$folder")
project=/srv/dtof-readout
tree=$folder$project

if [ ! -e "$folder/.complete" ]; then
  echo "$suite: debootstrap into $folder (minutes)"
  debootstrap --variant=minbase --include=ca-certificates,git,make "$suite" "$folder" \
    "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" > "$folder.debootstrap.log" 2>&1 \
    || fail "debootstrap failed: $(tail -n 1 "$folder.debootstrap.log") (log: $folder.debootstrap.log)"
  printf '#!/bin/sh\nexit 101\n' > "$folder/usr/sbin/policy-rc.d"  # packages start no services
  chmod +x "$folder/usr/sbin/policy-rc.d"
  touch "$folder/.complete"
fi
cp /etc/resolv.conf "$folder/etc/resolv.conf"

[ -d "$tree/.git" ] || git init --quiet "$tree"
git -C "$tree" fetch --quiet "$PWD" HEAD
git -C "$tree" checkout --quiet --force --detach FETCH_HEAD
echo "$suite: $(git -C "$tree" log -1 --format='commit %h, %s')"

# Runs a command in the project's folder of the Debian system. Its mounts and its processes end with it.
inside() {
  # shellcheck disable=SC2016  # the inner shell expands its own arguments
  unshare --mount --pid --fork --kill-child sh -c '
    mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" && mount -t tmpfs tmpfs "$1/run" &&
    exec chroot "$1" /usr/bin/env -i HOME=/root USER=root LANG=C.UTF-8 TERM=dumb \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin sh -c "cd $2 && $3"' \
    sh "$folder" "$project" "$1" < /dev/null
}

for command in "${commands[@]}"; do
  name=$(printf '%s' "$command" | tr -cs '[:alnum:]' _ | cut -c 1-40)
  log=$folder.${name%_}.log
  echo "$suite: $command (log: $log)"
  begin=$SECONDS
  if inside "$command" > "$log" 2>&1; then
    echo "$suite: $command passed in $((SECONDS - begin)) s"
  else
    tail -n 20 "$log" >&2
    fail "$suite: $command failed after $((SECONDS - begin)) s (log: $log)"
  fi
done
