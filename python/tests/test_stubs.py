# SPDX-License-Identifier: Apache-2.0
"""The types (_core.pyi) name what the module has, with the same parameters."""

import ast
import re
import unittest
from pathlib import Path

import dtof
from dtof import _core

STUB = ast.parse((Path(_core.__file__).parent / "_core.pyi").read_text(encoding="utf-8"))
INHERITED = set(dir(object)) | {"__module__", "_pybind11_conduit_v1_"}


def parameters(arguments: ast.arguments) -> list[str]:
    """Names in order, without self; those with a default end with '='."""
    plain = [*arguments.posonlyargs, *arguments.args]
    optional = len(plain) - len(arguments.defaults)
    names = [one.arg + ("=" if i >= optional else "") for i, one in enumerate(plain) if one.arg != "self"]
    if arguments.kwonlyargs:
        names.append("*")
    names += [one.arg + ("=" if default else "") for one, default in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    return [*names, "**kwargs"] if arguments.kwarg else names


def documented(function: object) -> list[str]:
    """The same from the first line that pybind11 writes into a docstring."""
    line = str(function.__doc__).splitlines()[0]
    inside = line[line.index("(") + 1:line.rindex(") ->")]
    depth, words = 0, [""]
    for letter in re.sub(r"'[^']*'", "''", inside):
        depth += letter in "[(<"
        depth -= letter in "])>"
        if letter == "," and depth == 0:
            words.append("")
        else:
            words[-1] += letter
    names = []
    for word in (word.strip() for word in words if word.strip()):
        name = word.split(":")[0].strip()
        if name == "self" or re.fullmatch(r"arg0", name):
            continue
        names.append(name + ("=" if " = " in word else ""))
    return names


def functions(body: list[ast.stmt]) -> dict[str, ast.FunctionDef]:
    return {one.name: one for one in body if isinstance(one, ast.FunctionDef)}


class StubTest(unittest.TestCase):
    def test_names(self) -> None:
        typed = {one.name for one in STUB.body if isinstance(one, ast.ClassDef | ast.FunctionDef)}
        typed -= {"EventArrays", "ResultArrays", "RivalArrays"}
        self.assertEqual(typed, {name for name in dir(_core) if not name.startswith("__")})
        self.assertEqual(sorted(dtof.__all__), dtof.__all__)
        self.assertLessEqual(typed, set(dtof.__all__))

    def test_functions(self) -> None:
        for name, function in functions(STUB.body).items():
            self.assertEqual(parameters(function.args), documented(getattr(_core, name)), name)

    def test_classes(self) -> None:
        for typed in (one for one in STUB.body if isinstance(one, ast.ClassDef)):
            if not hasattr(_core, typed.name):
                continue
            made = getattr(_core, typed.name)
            members = functions(typed.body)
            found = {name for name in vars(made) if name not in INHERITED}
            self.assertEqual(set(members) - {"__init__"}, found - {"__init__"}, typed.name)
            for name, member in members.items():
                if not any(isinstance(one, ast.Name) and one.id == "property" for one in member.decorator_list) and not (
                        name.startswith("__") and name != "__init__"):
                    self.assertEqual(parameters(member.args), documented(getattr(made, name)), f"{typed.name}.{name}")

    def test_everything_has_a_docstring(self) -> None:
        for name in dtof.__all__:
            if name != "__version__":
                said = str(getattr(dtof, name).__doc__)
                self.assertGreater(len([line for line in said.splitlines() if line.strip() and "->" not in line]), 0, name)


if __name__ == "__main__":
    unittest.main()
