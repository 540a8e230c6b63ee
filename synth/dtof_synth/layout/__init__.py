# SPDX-License-Identifier: Apache-2.0
"""A column placed and routed in OSU 0.18 um, with the tools of Debian's qflow; see docs/reference/layout.md."""
