#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/reference/maturity.md: each module of hdl/dtof.f with its stage and what earned it; --check only compares.

A stage is a consequence of the lists that commands read: formal/proofs.toml (`make formal`), and the folders whose modules are in the
netlists of `make synth` and `make sim-netlist`.
"""

import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = "docs/reference/maturity.md"
TECHNOLOGY = "technology"  # its modules are stand-ins, which silicon replaces
CHECKS_ALONE = "synthesis leaves it out"  # in the head of a module that has assertions and no circuit
WITHOUT_NETLIST = ("subsystem",)  # folders of hdl/ that make synth does not read

HEAD = """# Maturity of the blocks

Written by `scripts/maturity.py` from the list of RTL files, the list of proofs and the pages of the blocks.

| stage | a block of this stage | command |
|---:|---|---|
| 1 | is simulated beside its C++ model or a reference in Verilator | `make test` |
| 2 | is stage 1, is simulated in four states in Icarus Verilog, and its netlist is timed with margins and simulated beside the RTL | `make sim-icarus`, `make synth`, `make sim-netlist` |
| 3 | is stage 2, and it has a proof that planted bugs break | `make formal` |
| 4 | is stage 3, and it was measured in silicon | none yet |

"""


@dataclass(frozen=True)
class Block:
    name: str
    folder: str  # of hdl/
    page: str  # under docs/reference/, empty if there is none
    proofs: int
    bugs: int

    @property
    def stage(self) -> int:
        if self.folder in WITHOUT_NETLIST:
            return 1
        return 3 if self.proofs else 2

    @property
    def earned(self) -> str:
        proof = f"{self.proofs} proof{'s' if self.proofs > 1 else ''}, {self.bugs} planted bugs" if self.proofs else "no proof of its own"
        return f"{proof}; {'no netlist' if self.folder in WITHOUT_NETLIST else 'netlist timed and simulated'}"


def proofs(root: Path) -> dict[str, tuple[int, int]]:
    """By module: proofs and planted bugs."""
    found: dict[str, tuple[int, int]] = {}
    for proof in tomllib.loads((root / "formal/proofs.toml").read_text(encoding="utf-8"))["proof"]:
        for module in proof["module"].split(", "):
            number, bugs = found.get(module, (0, 0))
            found[module] = (number + 1, bugs + len(proof.get("bug", [])))
    return found


def pages(root: Path) -> dict[str, str]:
    """By module, the page that has its section."""
    return {name: f"blocks/{path.name}#{name}" for path in sorted((root / "docs/reference/blocks").glob("*.md"))
            for name in re.findall(r"^## `(\w+)`$", path.read_text(encoding="utf-8"), re.MULTILINE)}


def blocks(root: Path) -> list[Block]:
    """Modules of the file list in its order; packages, stand-ins and assertions are no blocks."""
    proved, described, found = proofs(root), pages(root), []
    for line in (root / "hdl/dtof.f").read_text(encoding="utf-8").splitlines():
        if not line.endswith(".sv") or line.startswith(("//", TECHNOLOGY)):
            continue
        text = (root / "hdl" / line).read_text(encoding="utf-8")
        if CHECKS_ALONE in text:
            continue
        for name in re.findall(r"^module (\w+)", text, re.MULTILINE):
            found.append(Block(name, line.split("/")[0], described.get(name, ""), *proved.get(name, (0, 0))))
    unknown = proved.keys() - {block.name for block in found}
    if unknown:
        raise SystemExit(f"error: formal/proofs.toml proves '{min(unknown)}', which hdl/dtof.f does not have")
    return found


def text(found: list[Block]) -> str:
    count = {stage: sum(block.stage == stage for block in found) for stage in (1, 2, 3)}
    lines = [f"{len(found)} blocks: {count[3]} of stage 3, {count[2]} of stage 2, {count[1]} of stage 1.", "",
             "| block | folder | stage | earned by |", "|---|---|---:|---|"]
    for block in found:
        name = f"[`{block.name}`]({block.page})" if block.page else f"`{block.name}`"
        lines.append(f"| {name} | {block.folder} | {block.stage} | {block.earned} |")
    return HEAD + "\n".join(lines) + "\n"


def main() -> int:
    new = text(blocks(ROOT))
    path = ROOT / PAGE
    if "--check" in sys.argv[1:]:
        if not path.is_file() or path.read_text(encoding="utf-8") != new:
            print(f"error: {PAGE} differs from what scripts/maturity.py writes: run it", file=sys.stderr)
            return 1
        return 0
    path.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
