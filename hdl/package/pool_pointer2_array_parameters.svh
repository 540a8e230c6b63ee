// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. A part of dtof_subsystem: the parameters of pool_pointer2_array.
          .NP(NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .GROUP_SIZE(GROUP_SIZE),
          .LABELS(LABELS),
          .SCORE_BITS(SCORE_BITS),
          .OFFSET_BITS(OFFSET_BITS),
          .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
          .POINTER_SHIFT(POINTER_SHIFT),
          .RIVAL_MOVES(RIVAL_MOVES),
          .SECOND_TARGET(SECOND_TARGET),
          .ENGINE_COLUMNS(ENGINE_COLUMNS),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
