# SPDX-License-Identifier: Apache-2.0
"""Proofs that a mutant of one RTL module is equivalent: module and mutant with equal inputs never differ.

Yosys builds the pair, ABC's property-directed reachability proves it without a bound, from all flip-flops at 0 and
through any inputs and resets. Modules with memories are not tried.
"""

import re
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

TIMEOUT_S = 60

Parameters = frozenset[tuple[str, int]]

_SCRIPT = """
read_verilog -sv -DSYNTHESIS -I{tree}/hdl/common {original}
{parameters}
hierarchy -check -top {module}
proc; flatten; opt_clean
rename -top gold
design -stash gold
read_verilog -sv -DSYNTHESIS -I{tree}/hdl/common {mutated}
{parameters}
hierarchy -check -top {module}
proc; flatten; opt_clean
rename -top gate
design -stash gate
design -copy-from gold -as gold gold
design -copy-from gate -as gate gate
select -assert-none t:$mem* t:dtof_sram
miter -equiv -flatten -make_outputs gold gate pair
hierarchy -top pair
delete -output pair/w:gold_* pair/w:gate_*
opt -full; async2sync; dffunmap; techmap; opt -full
setundef -init -zero
dfflegalize -cell $_DFF_P_ 0
abc -g AND -fast; opt_clean; aigmap
write_aiger -zinit {aiger}
"""


def instances(compiled: str) -> dict[str, frozenset[Parameters]]:
    """Parameters of every instance of each module in a compiled program of Icarus Verilog."""
    found: dict[str, set[Parameters]] = {}
    for scope in re.split(r"^(?=S_\w+ \.scope )", compiled, flags=re.MULTILINE):
        module = re.match(r'S_\w+ \.scope module, "[^"]*" "(\w+)"', scope)
        if module:
            values = re.findall(r'^P_\w+ \.param/l "(\w+)" 0 \d+ \d+, \+C4<([01]+)>;', scope, re.MULTILINE)
            found.setdefault(module.group(1), set()).add(frozenset((name, int(bits, 2)) for name, bits in values))
    return {module: frozenset(sets) for module, sets in found.items()}


def _never_differs(aiger: bytes) -> bool:
    """True if every output is the constant 0, as newer versions of Yosys find. ABC would call this undecided."""
    header, *lines = aiger.split(b"\n")
    latches, outputs = (int(number) for number in header.split()[3:5])
    found = lines[latches:latches + outputs]
    return len(found) == outputs > 0 and all(output == b"0" for output in found)


def proved(tree: Path, files: Iterable[str], file: str, mutated: str, parameters: Parameters) -> bool:
    """True if the module of `file`, with these parameters, never differs from the one in the text `mutated`."""
    module = Path(file).stem
    sources = [str(tree / name) for name in files]
    with tempfile.TemporaryDirectory() as scratch:
        changed = Path(scratch) / f"{module}.sv"
        changed.write_text(mutated)
        others = [str(changed) if name == str(tree / file) else name for name in sources]
        settings = " ".join(f"-set {name} {value}" for name, value in parameters)
        script = Path(scratch) / "prove.ys"
        script.write_text(
            _SCRIPT.format(
                tree=tree,
                original=" ".join(sources),
                mutated=" ".join(others),
                module=module,
                parameters=f"chparam {settings} {module}" if settings else "",
                aiger=Path(scratch) / "pair.aig",
            )
        )
        try:
            made = subprocess.run(["yosys", "-q", "-s", script], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  timeout=TIMEOUT_S)  # fmt: skip
            if made.returncode != 0:
                return False
            if _never_differs((Path(scratch) / "pair.aig").read_bytes()):
                return True
            commands = f"read_aiger {scratch}/pair.aig; scorr; pdr -T {TIMEOUT_S}"
            ran = subprocess.run(["yosys-abc", "-c", commands], text=True, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, cwd=scratch, timeout=2 * TIMEOUT_S)  # fmt: skip
        except subprocess.TimeoutExpired:
            return False
    return "Property proved" in ran.stdout
