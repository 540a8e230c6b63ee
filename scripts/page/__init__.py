# SPDX-License-Identifier: Apache-2.0
"""The page of `make report`: reports and pictures of this tree as static HTML."""
