# SPDX-License-Identifier: Apache-2.0
"""When synth/sta/resize.tcl does not resize gates."""

HOPELESS_NS = 0.4  # HOPELESS_NS of resize.tcl: no drive corrects a path that misses by more


def is_tried(slack_ns: float) -> bool:
    """Whether gates of an array with this slack, with margins, are resized."""
    return slack_ns >= -HOPELESS_NS
