// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. A part of dtof_subsystem: the parameters of dtof_array.
          .NP(NP),
          .NB(NB),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .POINTER_STEP(POINTER_STEP),
          .FRACTION_BITS(FRACTION_BITS),
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
          .GUARD(GUARD),
          .WINDOW_CENTRED(WINDOW_CENTRED),
          .POINTER_PORTS(POINTER_PORTS),
          .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
          .RAW_HISTOGRAM(RAW_HISTOGRAM),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
