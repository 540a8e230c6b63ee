# SPDX-License-Identifier: Apache-2.0
"""All that the result of a run depends on, as a digest: a kept result serves as long as its digest is the same.

A run reads the RTL by way of the elaborated netlist alone (mapping.elaborated). The mapper reads this netlist with its names and its order, which
influence ABC; the places in the source have gone from it before the digest is taken (canonical.py). So an edit of the RTL that leaves the
netlist of a configuration as it is leaves its result as it is. The netlist also has Yosys's version. The other inputs are:

- the flow: constraints, scripts and Python (group `run` of reports/reports.toml);
- the libraries of the cells, and what the libraries of the SRAMs say of the SRAMs of this configuration;
- what the flow's Python reads of the configuration and of its read-out;
- the clock for which the flow maps.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from . import mapping, readouts, report_inputs
from .configuration import Configuration, engine_memories, macro_sizes, memories, shared_memories
from .technology import Technology

_TEXT_ONLY = {"title", "enumerator", "summary", "style", "model", "choices", "defaults", "memories", "word"}  # of a read-out
_EXPRESSIONS = ("passes", "bin_width", "scan_width", "decode_clocks")
_OF_SIZES = re.compile(r"^  (?:cell|type) \((\w+)\) \{\n(?:   .*\n)*  \}\n", re.MULTILINE)  # groups of a library of SRAMs, one or more a size


def named_parameters(files: Iterable[Path]) -> list[str]:
    """Parameters that Python files name. A parameter that no file names enters a result by elaboration alone."""
    known = readouts.load().parameters.keys()
    return sorted({node.value for file in files for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
                   if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in known})


def read_by_python(item: Configuration, parameters: Iterable[str]) -> dict[str, object]:
    """What the flow's Python reads of a configuration for a run. `parameters`: those that Python names."""
    readout = {name: readouts.evaluate(value, item.parameters) if name in _EXPRESSIONS and value is not None else value
               for name, value in asdict(item.described).items() if name not in _TEXT_ONLY}
    return {"readout": readout, "parameters": {name: item[name] for name in parameters if name in item.parameters},
            "memories": {name: size.name for name, size in memories(item).items()},
            "engine_memories": {name: size.name for name, size in engine_memories(item).items()},
            "shared_memories": {name: size.name for name, size in shared_memories(item).items()}}


def _hash(*parts: str) -> str:
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def srams(library: str, names: set[str]) -> str:
    """The text of a library of SRAMs without what it says of other SRAMs than these. Types of buses are implied by the pins."""
    return _OF_SIZES.sub(lambda group: group[0] if group[1] in names else "", library)


@dataclass(frozen=True)
class Inputs:
    """Inputs that runs with one technology share. `digest`: of the flow, of the cells, and of the clock; `parameters`: those that the
    Python of a run names; `sram_libraries`: texts."""

    digest: str
    parameters: tuple[str, ...]
    sram_libraries: tuple[str, ...]

    def of(self, item: Configuration, netlist: str) -> str:
        """The digest of all inputs of a run. `netlist`: of mapping.elaborated."""
        used = {size.name for size in macro_sizes(item)}
        return _hash(self.digest, netlist, json.dumps(read_by_python(item, self.parameters), sort_keys=True),
                     *(srams(library, used) for library in self.sram_libraries))


def shared(technology: Technology) -> Inputs:
    flow = report_inputs.run_files(technology.root)
    python = [technology.root / name for name in flow if name.endswith(".py")]
    cells = [library.path.read_text(encoding="utf-8") for library in (technology.typical, technology.slow, technology.fast) if library]
    return Inputs(_hash(f"{technology.target_mhz}", *sorted(flow.values()), *cells), tuple(named_parameters(python)),
                  tuple(file.read_text(encoding="utf-8") for file in sorted(technology.kit.glob("*.lib"))))


def netlist(item: Configuration, technology: Technology, folder: Path) -> str:
    """Digest of the elaborated netlist. Files of the elaboration are left in the folder."""
    return _hash(mapping.elaborated(item, technology, folder))


def everything(technology: Technology) -> str:
    """Digest of the RTL's text, of the flow, and of the libraries with all SRAMs."""
    digest = hashlib.sha256(report_inputs.flow_digest(technology.root).encode())
    for file in sorted({*technology.kit.iterdir(), technology.typical.path, technology.slow.path}, key=lambda file: file.name):
        digest.update(file.name.encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()
