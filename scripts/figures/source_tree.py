# SPDX-License-Identifier: Apache-2.0
"""The project's files in the working tree, or in a commit."""

import hashlib
import re
import subprocess
import weakref
from pathlib import Path

from . import strip


def git_says(root: Path, *arguments: str) -> str | None:
    """Output of a git command; None if it fails or git is missing, e.g. in an archive of the project."""
    try:
        done = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


class SourceTree:
    """Files that git tracks or would track, named relative to the root with slashes. In an archive without .git: all files outside build
    folders."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.known: dict[str, str] = {}
        self.files = self._listed()

    def _listed(self) -> frozenset[str]:
        # An archive may lie in somebody's repository, whose git would say what it keeps.
        listed = git_says(self.root, "ls-files", "-co", "--exclude-standard", "-z") if (self.root / ".git").exists() else None
        if listed is not None:
            names = [name for name in listed.split("\0") if name]
        else:
            names = [path.relative_to(self.root).as_posix() for path in self.root.rglob("*")
                     if not {".git", ".mypy_cache", "build", "__pycache__"} & set(path.relative_to(self.root).parts)]
        return frozenset(name for name in names if (self.root / name).is_file())

    def read(self, name: str) -> bytes:
        return (self.root / name).read_bytes()

    def text(self, name: str) -> str:
        return self.read(name).decode("utf-8", errors="replace")

    def digest(self, name: str) -> str:
        if name not in self.known:
            self.known[name] = hashlib.sha256(strip.stripped(name, self.read(name))).hexdigest()[:16]
        return self.known[name]

    def matching(self, pattern: str) -> list[str]:
        """Files that match a pattern: `**` matches any folders, `*` part of a name."""
        expression = re.compile("".join(".*" if part == "**/" else "[^/]*" if part == "*" else re.escape(part)
                                        for part in re.split(r"(\*\*/|\*)", pattern)))
        return sorted(name for name in self.files if expression.fullmatch(name))


class CommitTree(SourceTree):
    """Files of a commit, read by one git process. A file that is equal in several commits is read and stripped once."""

    digests: dict[tuple[str, str], str] = {}  # by blob and suffix

    def __init__(self, root: Path, commit: str) -> None:
        self.commit = subprocess.run(["git", "rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}"], cwd=root, check=True,
                                     capture_output=True, text=True).stdout.strip()
        self.blobs: dict[str, str] = {}
        self.git = subprocess.Popen(["git", "cat-file", "--batch"], cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        weakref.finalize(self, _end, self.git)
        super().__init__(root)

    def _listed(self) -> frozenset[str]:
        done = subprocess.run(["git", "ls-tree", "-r", "-z", "--full-tree", self.commit], cwd=self.root, check=True,
                              capture_output=True, text=True)
        for entry in filter(None, done.stdout.split("\0")):
            description, name = entry.split("\t", 1)
            self.blobs[name] = description.split()[2]
        return frozenset(self.blobs)

    def read(self, name: str) -> bytes:
        assert self.git.stdin is not None and self.git.stdout is not None
        self.git.stdin.write(f"{self.blobs[name]}\n".encode())
        self.git.stdin.flush()
        size = int(self.git.stdout.readline().split()[2])
        content = self.git.stdout.read(size)
        self.git.stdout.read(1)
        return content

    def digest(self, name: str) -> str:
        key = (self.blobs[name], Path(name).suffix)
        if key not in self.digests:
            self.digests[key] = super().digest(name)
        return self.digests[key]


def _end(git: subprocess.Popen[bytes]) -> None:
    assert git.stdin is not None and git.stdout is not None
    git.stdin.close()
    git.stdout.close()
    git.wait()
