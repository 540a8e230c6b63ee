# SPDX-License-Identifier: Apache-2.0
"""The files of the project as they lie here, or as they were in a commit."""

import functools
import hashlib
import re
import subprocess
from pathlib import Path

from . import strip


class SourceTree:
    """Files that git keeps or would keep, by their names from the root with slashes."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.files = self._listed()

    def _listed(self) -> frozenset[str]:
        done = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=self.root, capture_output=True, text=True)
        if done.returncode == 0:
            names = [name for name in done.stdout.split("\0") if name]
        else:  # an archive without git
            names = [path.relative_to(self.root).as_posix() for path in self.root.rglob("*")
                     if not {"build", "__pycache__"} & set(path.relative_to(self.root).parts)]
        return frozenset(name for name in names if (self.root / name).is_file())

    def read(self, name: str) -> bytes:
        return (self.root / name).read_bytes()

    def text(self, name: str) -> str:
        return self.read(name).decode("utf-8", errors="replace")

    @functools.cache
    def digest(self, name: str) -> str:
        return hashlib.sha256(strip.stripped(name, self.read(name))).hexdigest()[:16]

    def matching(self, pattern: str) -> list[str]:
        """`**` stands for any folders, `*` for a part of one name."""
        expression = re.compile("".join(".*" if part == "**/" else "[^/]*" if part == "*" else re.escape(part)
                                        for part in re.split(r"(\*\*/|\*)", pattern)))
        return sorted(name for name in self.files if expression.fullmatch(name))


class CommitTree(SourceTree):
    def __init__(self, root: Path, commit: str) -> None:
        self.commit = subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}"], cwd=root, check=True,
                                     capture_output=True, text=True).stdout.strip()
        super().__init__(root)

    def _listed(self) -> frozenset[str]:
        done = subprocess.run(["git", "ls-tree", "-r", "-z", "--name-only", self.commit], cwd=self.root, check=True,
                              capture_output=True, text=True)
        return frozenset(name for name in done.stdout.split("\0") if name)

    @functools.cache
    def read(self, name: str) -> bytes:
        return subprocess.run(["git", "cat-file", "blob", f"{self.commit}:{name}"], cwd=self.root, check=True,
                              capture_output=True).stdout
