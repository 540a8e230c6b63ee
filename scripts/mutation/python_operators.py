# SPDX-License-Identifier: Apache-2.0
"""Mutants of Python: operators, constants, conditions, the two of a pair (setup and hold, typical and slow), removed statements."""

import ast
import io
import re
import tokenize
from collections.abc import Iterator

from mutation.mutant import Mutant
from mutation.operators import ARITHMETIC, BITWISE, RELATIONAL, Others

Located = ast.expr | ast.stmt  # what has a place in the text
OTHERS: dict[str, Others] = {
    "relational": {**RELATIONAL, "in": ("not in",), "not in": ("in",), "is": ("is not",), "is not": ("is",)},
    "arithmetic": {**ARITHMETIC, "//": ("*",), "**": ("*",)},
    "bitwise": {"&": ("|",), "|": ("&",), "^": ("|",)},
    "logical": {"and": ("or",), "or": ("and",)},
}
assert set(BITWISE) == set(OTHERS["bitwise"])
SYMBOLS = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=", ast.In: "in", ast.NotIn: "not in", ast.Is: "is",
    ast.IsNot: "is not", ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%", ast.FloorDiv: "//", ast.Pow: "**",
    ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^", ast.And: "and", ast.Or: "or",
}  # fmt: skip
KINDS = {symbol: kind for kind, table in OTHERS.items() for symbol in table}
# Words of names that are easily mixed up; a name with the other word is a mutant if the file has that name, too.
PAIRS = (
    ("typical", "slow"), ("slow", "fast"), ("setup", "hold"), ("read", "write"), ("reads", "writes"), ("width", "height"), ("rise", "fall"),
    ("max", "min"), ("any", "all"), ("ceil", "floor"), ("internal", "switching"), ("rows", "columns"), ("words", "bits"), ("x", "y"),
    ("column", "shared"), ("start", "end"), ("streaming", "other"), ("input", "output"),
)  # fmt: skip
BUILT_IN = {"max", "min", "any", "all", "ceil", "floor"}  # known whether or not the file has them


def other_names(name: str) -> list[str]:
    """Names in which one word is replaced by its partner."""
    parts = re.split(r"(_)", name)
    found = []
    for index, part in enumerate(parts):
        for pair in PAIRS:
            for word, partner in (pair, pair[::-1]):
                if part.lower() == word:
                    parts_of_other = [*parts[:index], partner.upper() if part.isupper() else partner, *parts[index + 1 :]]
                    found.append("".join(parts_of_other))
    return found


class Finder:
    """Finds the mutants of one file."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.text = text
        self.lines = text.splitlines()
        self.tree = ast.parse(text)
        self._starts = [0]
        for line in text.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self._comments = [
            (self._starts[token.start[0] - 1] + token.start[1], self._starts[token.end[0] - 1] + token.end[1])
            for token in tokenize.generate_tokens(io.StringIO(text).readline)
            if token.type == tokenize.COMMENT
        ]
        nodes = list(ast.walk(self.tree))
        self._names = BUILT_IN | {node.id for node in nodes if isinstance(node, ast.Name)}
        self._names |= {node.attr for node in nodes if isinstance(node, ast.Attribute)}
        self._texts = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
        self._place = 0

    def offset(self, line: int, column: int) -> int:
        """Position in the text; `column` counts bytes of UTF-8, as those of ast do."""
        return self._starts[line - 1] + len(self.lines[line - 1].encode()[:column].decode())

    def span(self, node: Located) -> tuple[int, int]:
        assert node.end_lineno is not None and node.end_col_offset is not None  # what was parsed has both
        return self.offset(node.lineno, node.col_offset), self.offset(node.end_lineno, node.end_col_offset)

    def source(self, node: Located) -> str:
        begin, end = self.span(node)
        return self.text[begin:end]

    def change(self, operator: str, begin: int, end: int, mutated: str, statement: bool = False) -> Mutant:
        line = self.text.count("\n", 0, begin) + 1
        return Mutant(
            file=self.file,
            line=line,
            begin=begin,
            end=end,
            original=self.text[begin:end],
            mutated=mutated,
            operator=operator,
            source=self.lines[line - 1].strip(),
            above=self.lines[line - 2].strip() if line > 1 else "",
            place=self._place,
            statement=statement,
        )

    def replaced(self, operator: str, node: Located, mutated: str) -> Mutant:
        return self.change(operator, *self.span(node), mutated)

    def symbols(self, whole: ast.expr, left: ast.expr, right: ast.expr, symbol: str) -> Iterator[Mutant]:
        """Other operators between two operands."""
        begin, end = self.span(whole)
        gap = self.span(left)[1]
        pattern = re.compile(r"\s+".join(map(re.escape, symbol.split())))
        for found in pattern.finditer(self.text, gap, self.span(right)[0]):
            if any(first <= found.start() < last for first, last in self._comments):
                continue
            for other in OTHERS[KINDS[symbol]][symbol]:
                yield self.change(KINDS[symbol], begin, end, self.text[begin : found.start()] + other + self.text[found.end() : end])
            return

    def statements(self, body: list[ast.stmt]) -> Iterator[Mutant]:
        for node in body:
            self._place = self.span(node)[0]
            yield from self.statement(node)

    def statement(self, node: ast.stmt) -> Iterator[Mutant]:
        documentation = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if documentation or isinstance(node, (ast.Import, ast.ImportFrom, ast.Pass, ast.Assert, ast.Global, ast.Nonlocal)):
            return
        if self._removable(node):
            yield self.change("statement", *self.span(node), "pass", statement=True)
        if isinstance(node, ast.Raise):  # its message is no figure
            return
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            for default in [*node.args.defaults, *node.args.kw_defaults] if isinstance(node, ast.FunctionDef) else []:
                if default is not None:
                    yield from self.expression(default)
            yield from self.statements(node.body)
            return
        if isinstance(node, ast.If) and "__name__" in self.source(node.test):
            return
        if isinstance(node, (ast.If, ast.While)):
            yield self.replaced("condition", node.test, f"not ({self.source(node.test)})")
        blocks = [name for name in ("body", "orelse", "finalbody") if isinstance(getattr(node, name, None), list)]
        for name, child in ast.iter_fields(node):
            if name in blocks or name in ("handlers", "annotation"):
                continue
            for part in child if isinstance(child, list) else [child]:
                if isinstance(part, (ast.expr, ast.withitem)):
                    yield from self.expression(part)
        for name in blocks:
            yield from self.statements(getattr(node, name))
        for handler in getattr(node, "handlers", ()):
            yield from self.statements(handler.body)

    @staticmethod
    def _removable(node: ast.stmt) -> bool:
        if isinstance(node, ast.Assign):  # a name that is never set is found by whoever reads it
            return any(isinstance(target, (ast.Attribute, ast.Subscript)) for target in node.targets)
        return isinstance(node, (ast.Expr, ast.AugAssign, ast.Raise, ast.Continue, ast.Break))

    def expression(self, node: ast.AST) -> Iterator[Mutant]:
        """Mutants of an expression and of its parts."""
        if isinstance(node, ast.JoinedStr):  # Python before 3.12 does not say where its parts stand
            return
        if isinstance(node, ast.Constant):
            yield from self.constant(node)
        elif isinstance(node, ast.BinOp) and not any(self._is_text(side) for side in (node.left, node.right)):
            yield from self.symbols(node, node.left, node.right, SYMBOLS.get(type(node.op), "+"))
        elif isinstance(node, ast.Compare):
            for left, operator, right in zip([node.left, *node.comparators], node.ops, node.comparators):
                yield from self.symbols(node, left, right, SYMBOLS[type(operator)])
        elif isinstance(node, ast.BoolOp):
            for left, right in zip(node.values, node.values[1:]):
                yield from self.symbols(node, left, right, SYMBOLS[type(node.op)])
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub)):
            yield self.replaced("negation", node, f"({self.source(node.operand)})")
        elif isinstance(node, ast.IfExp):
            test, yes, no = (self.source(part) for part in (node.test, node.body, node.orelse))
            yield self.replaced("choice", node, f"({no}) if ({test}) else ({yes})")
        elif isinstance(node, ast.comprehension):
            for condition in node.ifs:
                yield self.replaced("condition", condition, f"(not ({self.source(condition)}))")
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            for other in other_names(node.id):
                if other in self._names:
                    yield self.replaced("name", node, other)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
            for other in other_names(node.attr):
                if other in self._names:
                    begin, end = self.span(node)
                    yield self.change("name", begin, end, self.text[begin : end - len(node.attr)] + other)
        for child in ast.iter_child_nodes(node):
            yield from self.expression(child)

    @staticmethod
    def _is_text(node: ast.expr) -> bool:
        return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))

    def constant(self, node: ast.Constant) -> Iterator[Mutant]:
        value, text = node.value, self.source(node)
        if isinstance(value, bool):
            yield self.replaced("constant", node, str(not value))
        elif isinstance(value, int):
            for step in ("+", "-"):
                yield self.replaced("constant", node, f"({text} {step} 1)")
        elif isinstance(value, float):
            for mutated in (f"({text} * 1.1)", f"({text} / 2)") if value else ("1.0",):
                yield self.replaced("constant", node, mutated)
        elif isinstance(value, str):
            for other in other_names(value):
                if other in self._texts:
                    yield self.replaced("name", node, text.replace(value, other))


def mutants(file: str, text: str) -> list[Mutant]:
    finder = Finder(file, text)
    return list(dict.fromkeys(finder.statements(finder.tree.body)))
