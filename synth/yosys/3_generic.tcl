# SPDX-License-Identifier: Apache-2.0
# Technology-independent synthesis. The column stays a separate module, so that it is synthesised once
# for any number of columns, and so does an engine that columns share. Everything else is flattened into the shared logic.
#
# Runs `synth` up to its fine part, and the fine part without opt_share: merging the +step and -step of a pointer behind one
# multiplexed adder saves some area but puts the comparison in front of the adder.
# In a pool read-out four columns share an SRAM; the module is then all four columns.
setattr -mod -set keep_hierarchy 1 *_column *_quad *_engine
setattr -mod -unset keep_hierarchy *dtof_pool_column
if {[llength $kept_modules]} { setattr -mod -set keep_hierarchy 1 {*}$kept_modules }
synth -flatten -noshare -top $top -run coarse:fine
opt -fast -undriven -fine
techmap
opt_expr
opt_merge
opt_dff
opt_clean
