# SPDX-License-Identifier: Apache-2.0
"""Liberty files as a tree of groups: one structure for reading and for writing."""

from __future__ import annotations

import gzip
import re
from dataclasses import dataclass, field
from pathlib import Path

from .errors import FlowError

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[(){}:;,]|[^\s(){}:;,"]+')
_NOISE = re.compile(r"/\*.*?\*/|//[^\n]*|\\\r?\n", re.DOTALL)


# Delays from 50 to 50 %, slews from 20 to 80 %.
THRESHOLDS = [*((f"{kind}_threshold_pct_{edge}", "50") for kind in ("input", "output")
                for edge in ("rise", "fall")),
              *((f"slew_lower_threshold_pct_{edge}", "20") for edge in ("rise", "fall")),
              *((f"slew_upper_threshold_pct_{edge}", "80") for edge in ("rise", "fall"))]


@dataclass
class Group:
    """`kind (args) { attributes; groups; trailing }`. A list value is a complex attribute, `name (a, b);`."""

    kind: str
    args: list[str] = field(default_factory=list)
    attributes: list[tuple[str, str | list[str]]] = field(default_factory=list)
    groups: list[Group] = field(default_factory=list)
    trailing: list[tuple[str, str | list[str]]] = field(default_factory=list)

    @property
    def name(self) -> str:
        return self.args[0] if self.args else ""

    def get(self, attribute: str, default: str = "") -> str:
        for name, value in self.attributes:
            if name == attribute and isinstance(value, str):
                return value
        return default

    def number(self, attribute: str, default: float = 0.0) -> float:
        return float(self.get(attribute) or default)

    def children(self, kind: str) -> list[Group]:
        return [group for group in self.groups if group.kind == kind]

    def add(self, child: Group) -> Group:
        self.groups.append(child)
        return child

    def write(self, indent: int = 0) -> str:
        pad = "  " * indent

        def line(name: str, value: str | list[str]) -> str:
            return f"{pad}  {name} ({', '.join(value)});" if isinstance(value, list) \
                else f"{pad}  {name} : {value};"

        lines = [f"{pad}{self.kind} ({', '.join(self.args)}) {{"]
        lines += [line(*attribute) for attribute in self.attributes]
        lines += [group.write(indent + 1) for group in self.groups]
        lines += [line(*attribute) for attribute in self.trailing]
        lines.append(f"{pad}}}")
        return "\n".join(lines)


def bus_type(bits: int, lowest: int = 0) -> Group:
    """The type `bits_<width>_<lowest>` of a descending bus."""
    return Group("type", [f"bits_{bits}_{lowest}"], [
        ("base_type", "array"), ("data_type", "bit"), ("bit_width", str(bits)),
        ("bit_from", str(bits - 1 + lowest)), ("bit_to", str(lowest)), ("downto", "true")])


def quoted(numbers: list[float], digits: int = 6) -> str:
    return '"' + ", ".join(f"{number:.{digits}g}" for number in numbers) + '"'


def _unquote(token: str) -> str:
    return token[1:-1] if token.startswith('"') else token


def parse(text: str, where: str) -> Group:
    """The library group of a Liberty text; FlowError if the text is none."""
    tokens = _TOKEN.findall(_NOISE.sub(" ", text))
    position = 0

    def arguments() -> list[str]:
        nonlocal position
        found: list[str] = []
        position += 1
        while tokens[position] != ")":
            if tokens[position] != ",":
                found.append(_unquote(tokens[position]))
            position += 1
        position += 1
        return found

    def body(group: Group) -> None:
        nonlocal position
        while tokens[position] != "}":
            name = tokens[position]
            position += 1
            if name == ";":
                continue
            if tokens[position] == ":":
                position += 1
                words: list[str] = []
                while tokens[position] not in (";", "}"):
                    words.append(_unquote(tokens[position]))
                    position += 1
                    if tokens[position - 1].startswith('"'):  # IHP's files have no semicolon behind some strings
                        break
                group.attributes.append((name, " ".join(words)))
            elif tokens[position] == "(":
                args = arguments()
                if tokens[position] == "{":
                    position += 1
                    body(group.add(Group(name, args)))
                    position += 1
                else:
                    group.attributes.append((name, args))
            else:
                raise FlowError(f"{where}: '{name}' is followed by '{tokens[position]}', not by ':' or '('")

    root = Group("file")
    tokens.append("}")
    try:
        body(root)
    except IndexError:
        raise FlowError(f"{where}: the Liberty text ends inside a group") from None
    libraries = root.children("library")
    if position != len(tokens) - 1 or len(libraries) != 1:
        raise FlowError(f"{where}: no Liberty library found")
    return libraries[0]


def read(path: Path) -> Group:
    try:
        raw = path.read_bytes()
        text = (gzip.decompress(raw) if path.suffix == ".gz" else raw).decode("utf-8", "replace")
    except (OSError, EOFError) as error:
        raise FlowError(f"{path}: cannot read the Liberty file ({error})") from None
    return parse(text, str(path))
