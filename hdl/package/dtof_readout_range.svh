// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. What dtof_array says of a READOUT that it does not know.
`ifndef DTOF_READOUT_RANGE
`define DTOF_READOUT_RANGE "dtof_array: READOUT must be 0 to 8"
`endif
