# SPDX-License-Identifier: Apache-2.0
"""A small project in a folder of its own, for tests of scripts/figures/."""

import subprocess
import tempfile
import unittest
from pathlib import Path

from figures import reports, staleness
from figures.source_tree import SourceTree

LIST = """\
[inputs]
rtl = ["hdl/*.sv"]
[report.area]
command = "make synth"
minutes = 40
first = true
pages = ["area.md"]
files = ["area.csv"]
inputs = ["@rtl", "python:synth/flow.py"]
[report.pareto]
command = "make pareto"
minutes = 0.1
pages = ["pareto.md"]
inputs = ["reports/area.csv", "cpp:app/commands/main.cpp", "!models/dtof/unused/*"]
"""
FILES = {
    "reports/reports.toml": LIST,
    "reports/area.md": "# Area\n\ntext\n",
    "reports/area.csv": "mm2\n1.1\n",
    "reports/pareto.md": "# Pareto\n",
    "hdl/a.sv": "module a;  // one\nendmodule\n",
    "synth/flow.py": "import helper\nfrom parts import adder\n\nprint(helper, adder)  # says it\n",
    "synth/helper.py": '"""Helps."""\nVALUE = 1\n',
    "synth/parts/__init__.py": "",
    "synth/parts/adder.py": "ADDED = 2\n",
    "synth/unrelated.py": "VALUE = 3\n",
    "app/commands/main.cpp": '#include "dtof/core/a.hpp"\n#include "dtof/unused/d.hpp"\n',
    "models/dtof/unused/d.hpp": "int d();\n",
    "models/dtof/core/a.hpp": "int a();\n",
    "models/dtof/core/a.cpp": '#include "dtof/core/a.hpp"\n#include "dtof/core/b.hpp"\nint a() { return b(); }\n',
    "models/dtof/core/b.hpp": "int b();\n",
    "models/dtof/core/b_part.cpp": '#include "dtof/core/b.hpp"\nint b() { return 1; }\n',
    "models/dtof/core/c.hpp": "int c();\n",
}


class Project(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "project"
        for name, text in FILES.items():
            self.write(name, text)
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments: str) -> str:
        return subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@example.org", *arguments], cwd=self.root, check=True,
                              capture_output=True, text=True).stdout.strip()

    def commit(self) -> str:
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "state")
        return self.git("rev-parse", "HEAD")

    def write(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def reports(self) -> dict[str, reports.Report]:
        return reports.load(self.root)

    def measure(self, *names: str) -> None:
        for name in names or self.reports():
            staleness.begin(self.root, self.reports()[name], SourceTree(self.root))
            staleness.record(self.root, self.reports()[name])

    def stale(self) -> dict[str, tuple[str, ...]]:
        return {name: one.places for name, one in staleness.stale(self.root, self.reports(), SourceTree(self.root)).items()}
