# SPDX-License-Identifier: Apache-2.0
# Technology-independent synthesis. The column stays a module of its own, so that it is synthesised once
# however many columns the array has; everything else is flattened into the shared logic.
setattr -mod -set keep_hierarchy 1 *_column
synth -flatten -top $top -run coarse:check
