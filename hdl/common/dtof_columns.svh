// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. A part of dtof_array: column c.
      case (READOUT)
        dtof_pkg::READOUT_EZPOINTER: begin : g_ez_pointer
          `DTOF_COLUMN(dtof_ez_pointer_column)
        end
        dtof_pkg::READOUT_HISPOINTER1, dtof_pkg::READOUT_HISPOINTER: begin : g_his_pointer
          `DTOF_COLUMN(dtof_his_pointer_column)
        end
        dtof_pkg::READOUT_SIFH, dtof_pkg::READOUT_FIFH, dtof_pkg::READOUT_THREESTEPS: begin : g_interframe_histogram
          `DTOF_COLUMN(dtof_interframe_histogram_column)
        end
        dtof_pkg::READOUT_PIFH, dtof_pkg::READOUT_HISTOGRAM: begin : g_partitioned_histogram
          `DTOF_COLUMN(dtof_partitioned_histogram_column)
        end
        dtof_pkg::READOUT_COARSEHISTOGRAM: begin : g_coarse_histogram
          `DTOF_COLUMN(dtof_coarse_histogram_column)
        end
        default: begin : g_no_readout
        end
      endcase
