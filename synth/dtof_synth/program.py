# SPDX-License-Identifier: Apache-2.0
"""How every program of scripts/ and synth/ ends. This package has the module because both folders find the package."""

import os
import select
import signal
import sys
from collections.abc import Callable
from typing import NoReturn


def _reader_is_gone() -> bool:
    """True if standard output is a pipe that nobody reads any more."""
    poll = select.poll()
    poll.register(sys.stdout, 0)
    return any(event & select.POLLERR for _, event in poll.poll(0))


def run(main: Callable[[], int | str | None]) -> NoReturn:
    """Calls main and ends with its exit status. If the reader of the output has gone (`... | head`), the program ends without a message by
    SIGPIPE, as other programs do; a shell then sees the status 141."""
    try:
        try:
            status = main()
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        if not _reader_is_gone():  # then the pipe to a child broke
            raise
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGPIPE)
    sys.exit(status)
