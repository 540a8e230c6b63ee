# SPDX-License-Identifier: Apache-2.0
"""The page of this tree, moved elsewhere, for tests: made once for all tests of a process, because making the page takes seconds."""

import atexit
import functools
import shutil
import tempfile
from pathlib import Path

from page.library import Library
from page.site import Site

ROOT = Path(__file__).resolve().parent.parent.parent
NO_LIBRARY = Library(None, None, "npm is not installed")


@functools.cache
def _made(library: Library) -> tuple[Path, list[str]]:
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    made, kept = Path(folder.name) / "made", Path(folder.name) / "kept"
    wrong = Site(ROOT, made, library).write()
    made.rename(kept)  # a link into the folder that the page was made in leads nowhere
    return kept, wrong


def moved_page(folder: Path, library: Library = NO_LIBRARY) -> tuple[Path, list[str]]:
    """A copy in `folder`, which the test may change, and what Site.write() found wrong."""
    kept, wrong = _made(library)
    return Path(shutil.copytree(kept, folder / "moved elsewhere")), wrong
