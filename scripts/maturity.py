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

from dtof_synth import program

ROOT = Path(__file__).resolve().parent.parent
PAGE = "docs/reference/maturity.md"
TECHNOLOGY = "technology"  # its modules are stand-ins, which silicon replaces
CHECKS_ALONE = "synthesis leaves it out"  # in the head of a module that has assertions and no circuit
WITHOUT_NETLIST = {"subsystem"}  # folders of hdl/ that make synth does not read
SHARED = "common"  # its modules are in a netlist only if a module of a folder that make synth reads uses them
COMMENT = re.compile(r"//.*")

HEAD = """# Maturity of the blocks

`scripts/maturity.py` writes this page from the list of RTL files, the list of proofs and the pages of the blocks. A *block* is an RTL
module. A stage includes all stages below it.

| stage | evidence for a block of this stage | command |
|---:|---|---|
| 1 | Verilator simulates the block, and its results equal those of the C++ model or of a reference | `make test` |
| 2 | Icarus Verilog simulates the block with X; its netlist meets timing with margins, and is simulated beside the RTL | `make sim-icarus`, `make synth`, `make sim-netlist` |
| 3 | a proof of the block, which fails with each planted bug | `make formal` |
| 4 | measurements in silicon (no block yet) | none |

"""


def counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


@dataclass(frozen=True)
class Block:
    name: str
    folder: str  # of hdl/
    page: str  # under docs/reference/, empty if there is none
    netlist: bool
    proofs: int
    bugs: int

    @property
    def stage(self) -> int:
        if not self.netlist:
            return 1
        return 3 if self.proofs else 2

    @property
    def earned(self) -> str:
        proof = f"{counted(self.proofs, 'proof')}, {counted(self.bugs, 'planted bug')}" if self.proofs else "no proof of its own"
        return f"{proof}; {'netlist timed and simulated' if self.netlist else 'no netlist'}"


def proofs(root: Path) -> dict[str, tuple[int, int]]:
    """Numbers of proofs and of planted bugs, by module."""
    found: dict[str, tuple[int, int]] = {}
    for proof in tomllib.loads((root / "formal/proofs.toml").read_text(encoding="utf-8"))["proof"]:
        for module in proof["module"].split(", "):
            number, bugs = found.get(module, (0, 0))
            found[module] = (number + 1, bugs + len(proof.get("bug", [])))
    return found


def pages(root: Path) -> dict[str, str]:
    """Address of the section about a module, by module."""
    return {name: f"blocks/{path.name}#{name}" for path in sorted((root / "docs/reference/blocks").glob("*.md"))
            for name in re.findall(r"^## `(\w+)`$", path.read_text(encoding="utf-8"), re.MULTILINE)}


def blocks(root: Path) -> list[Block]:
    """Modules of the file list in its order; packages, stand-ins and assertions are no blocks."""
    proved, described, found = proofs(root), pages(root), []
    files = [line for line in (root / "hdl/dtof.f").read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and not line.startswith("//")]
    texts = {file: (root / "hdl" / file).read_text(encoding="utf-8") for file in files}
    words = {file: set(re.findall(r"\w+", COMMENT.sub("", text))) for file, text in texts.items()}
    for file, text in texts.items():
        folder = file.split("/")[0]
        if folder == TECHNOLOGY or CHECKS_ALONE in text:
            continue
        for name in re.findall(r"^module (\w+)", text, re.MULTILINE):
            users = {other.split("/")[0] for other in files if other != file and name in words[other]} if folder == SHARED else {folder}
            found.append(Block(name, folder, described.get(name, ""), not users <= WITHOUT_NETLIST, *proved.get(name, (0, 0))))
    unknown = proved.keys() - {block.name for block in found}
    if unknown:
        raise SystemExit(f"error: formal/proofs.toml proves '{min(unknown)}', which hdl/dtof.f does not have")
    return found


def text(found: list[Block]) -> str:
    count = {stage: sum(block.stage == stage for block in found) for stage in (1, 2, 3)}
    lines = [f"{len(found)} blocks: {count[3]} of stage 3, {count[2]} of stage 2, {count[1]} of stage 1.", "",
             "| block | folder | stage | evidence |", "|---|---|---:|---|"]
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
    program.run(main)
