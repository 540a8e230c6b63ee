// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. A part of dtof_pkg.

  // Values of the parameter READOUT.
  localparam int READOUT_EZPOINTER = 0;
  localparam int READOUT_HISPOINTER1 = 1;
  localparam int READOUT_HISPOINTER = 2;
  localparam int READOUT_SIFH = 3;
  localparam int READOUT_FIFH = 4;
  localparam int READOUT_THREESTEPS = 5;
  localparam int READOUT_PIFH = 6;
  localparam int READOUT_HISTOGRAM = 7;
  localparam int READOUT_COARSEHISTOGRAM = 8;
  localparam int READOUT_POOLPOINTER = 64;  // of dtof_subsystem alone: dtof_pool_pointer_array

  function automatic bit is_readout(input int readout);
    is_readout = readout >= 0 && readout < 9;
  endfunction

  function automatic bit has_histogram(input int readout);
    case (readout)
      READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_SIFH, READOUT_FIFH, READOUT_THREESTEPS, READOUT_PIFH, READOUT_HISTOGRAM, READOUT_COARSEHISTOGRAM: has_histogram = 1'b1;
      default: has_histogram = 1'b0;
    endcase
  endfunction

  // A word a pixel beside its histogram, which timestamps move, or which is read ahead of them.
  function automatic bit has_word(input int readout);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_SIFH, READOUT_FIFH, READOUT_THREESTEPS, READOUT_PIFH: has_word = 1'b1;
      default: has_word = 1'b0;
    endcase
  endfunction

  function automatic bit is_word_moved(input int readout);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER: is_word_moved = 1'b1;
      default: is_word_moved = 1'b0;
    endcase
  endfunction

  function automatic bit is_word_read_ahead(input int readout);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_SIFH, READOUT_FIFH, READOUT_THREESTEPS: is_word_read_ahead = 1'b1;
      default: is_word_read_ahead = 1'b0;
    endcase
  endfunction

  // Passes over the stream before the final one.
  function automatic int coarse_passes(input int readout, input int np, input int nb);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISTOGRAM, READOUT_COARSEHISTOGRAM: coarse_passes = 0;
      READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_SIFH, READOUT_FIFH: coarse_passes = 1;
      READOUT_THREESTEPS: coarse_passes = 3;
      READOUT_PIFH: coarse_passes = (1 << (np - nb)) - 1;
      default: coarse_passes = 0;
    endcase
  endfunction

  // log2 of the bins that the histogram SRAM holds for a pixel; 1 without one.
  function automatic int bin_width(input int readout, input int np, input int nb);
    case (readout)
      READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_SIFH, READOUT_PIFH, READOUT_COARSEHISTOGRAM: bin_width = nb;
      READOUT_FIFH: bin_width = max_of(nb, (np - nb));
      READOUT_THREESTEPS: bin_width = 4;
      READOUT_HISTOGRAM: bin_width = np;
      default: bin_width = 1;
    endcase
  endfunction

  // log2 of the bins that the result is searched in.
  function automatic int scan_width(input int readout, input int np, input int nb);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER: scan_width = 0;
      READOUT_SIFH, READOUT_PIFH, READOUT_COARSEHISTOGRAM: scan_width = nb;
      READOUT_FIFH: scan_width = np - nb;
      READOUT_THREESTEPS: scan_width = 4;
      READOUT_HISTOGRAM: scan_width = np;
      default: scan_width = 0;
    endcase
  endfunction

  // Clocks between a pixel's last bin and its result, beyond those of the peak search.
  function automatic int decode_clocks(input int readout, input int np, input int nb, input int fraction_bits);
    case (readout)
      READOUT_COARSEHISTOGRAM: decode_clocks = ((np - nb) + fraction_bits) + 4;
      default: decode_clocks = 0;
    endcase
  endfunction

  // Bits of a result's fields beside its code.
  function automatic int fraction_width(input int readout, input int fraction_bits);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER, READOUT_COARSEHISTOGRAM: fraction_width = fraction_bits;
      READOUT_SIFH, READOUT_FIFH, READOUT_THREESTEPS, READOUT_PIFH, READOUT_HISTOGRAM: fraction_width = 0;
      default: fraction_width = 0;
    endcase
  endfunction

  function automatic int confidence_width(input int readout, input int count_width,
                                          input int pointer_confidence_width);
    case (readout)
      READOUT_EZPOINTER, READOUT_HISPOINTER1, READOUT_HISPOINTER: confidence_width = pointer_confidence_width;
      READOUT_SIFH, READOUT_FIFH, READOUT_THREESTEPS, READOUT_PIFH, READOUT_HISTOGRAM, READOUT_COARSEHISTOGRAM: confidence_width = count_width;
      default: confidence_width = 0;
    endcase
  endfunction
