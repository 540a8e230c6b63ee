# SPDX-License-Identifier: Apache-2.0
"""The one error that ends the flow with one line for the user."""


class FlowError(Exception):
    """Says where and what; the command line prints it and exits with status 1."""
