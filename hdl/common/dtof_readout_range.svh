// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. The message of dtof_array for a READOUT out of range.
`ifndef DTOF_READOUT_RANGE
`define DTOF_READOUT_RANGE "dtof_array: READOUT must be 0 to 8"
`endif
