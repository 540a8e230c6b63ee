#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The commands of docs/user/python.md as a new user types them: packages, a venv, pip, then every example, first as a script and then as a notebook
# in a kernel of the venv. The examples run in a folder of their own, beside which no source tree is. Prints the seconds of each step.
# In a fresh Debian: scripts/try_debian.sh SUITE --run scripts/try_python.sh
set -euo pipefail
cd "$(dirname "$0")/.."
tree=$PWD
begin=$SECONDS
step() {
  echo "python: $1 in $((SECONDS - begin)) s"
  begin=$SECONDS
}

scripts/install_packages.sh python
step "packages"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python=$folder/venv/bin/python
/usr/bin/python3 -m venv --system-site-packages "$folder/venv"
"$folder/venv/bin/pip" install --no-build-isolation .
step "pip install"
"$python" -m ipykernel install --sys-prefix
export PYDEVD_DISABLE_FILE_VALIDATION=1  # Python 3.11 and newer: the kernel's debugger warns of modules that it cannot stop in

mkdir "$folder/work"
cd "$folder/work"
[ ! -x "$tree/build/cpp/bin/dtof" ] || export DTOF_BIN=$tree/build/cpp/bin  # for own_sensor, which else ends without a chip
"$python" -c 'import dtof; print(f"python: {dtof.__file__}, version {dtof.__version__}")' | tee said
grep -q "$folder/venv" said
for script in "$tree"/examples/python/*.py; do
  name=$(basename "$script" .py)
  cp "$script" "$tree/examples/python/$name.ipynb" .
  "$python" -W error::DeprecationWarning:__main__ "$name.py" scripts
  step "$name.py"
  "$python" - "$name.ipynb" << 'END'
import sys
import nbclient, nbformat
book = nbformat.read(sys.argv[1], as_version=4)
nbclient.NotebookClient(book, kernel_name="python3", timeout=600).execute()
outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
print("".join(output.text for output in outputs if output.output_type == "stream"), end="")
print("pictures in the notebook:", sum("image/png" in output.get("data", {}) for output in outputs))
END
  step "$name.ipynb"
done
cmp <(cd scripts && find . -type f | sort) <(cd build/python_examples && find . -type f | sort)  # script and notebook write the same files
echo "python: $(find build/python_examples -type f | wc -l) files of $(find . -maxdepth 1 -name '*.ipynb' | wc -l) notebooks"
