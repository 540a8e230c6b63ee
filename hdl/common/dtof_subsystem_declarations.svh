// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml. A part of dtof_subsystem: its arrays' parameters.
    // bits of a TDC timestamp
    parameter int NP = 10,
    // bits of the coarse histogram index
    parameter int NB = (READOUT == dtof_pkg::READOUT_SIFH) ? (NP / 2) + 1
        : (READOUT == dtof_pkg::READOUT_PIFH) ? dtof_pkg::min_of(NP, 6)
        : (READOUT == dtof_pkg::READOUT_HISTOGRAM) ? NP
        : (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(NP, 5)
        : NP / 2,
    // pixels a column serves
    parameter int PIXELS_PER_SRAM = 160,
    // columns working in parallel
    parameter int SRAM_NUM = 200,
    // timestamps per pixel and acquisition
    parameter int SLOTS = 2,
    // bits of a histogram bin, a counter that never wraps
    parameter int COUNT_WIDTH = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 7
        : 10,
    // bins a pointer moves per timestamp
    parameter int POINTER_STEP = 1,
    // fractional bits of the pointer
    parameter int FRACTION_BITS = (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(2, (16 - NP))
        : 0,
    // bits of a pointer's confidence, 0 for none
    parameter int CONFIDENCE_WIDTH = 4,
    // hisPointer: side band beyond half a coarse bin, the FWHM of 2 ns in 45 ns
    parameter int GUARD = ((2 << NP) + 44) / 45,
    // SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
    parameter int WINDOW_CENTRED = 0,
    // ports of the pointer SRAM; 1 halves its cell
    parameter int POINTER_PORTS = 2,
    // one status bit an address instead of clearing
    parameter int SIGNALLED_CLEAR = 0,
    // 1: only timestamps from `gate_begin_i` to below `gate_end_i` count
    parameter int TIME_GATE = 0,
    // 1: a frame may send histograms instead of results (`raw_i`)
    parameter int RAW_HISTOGRAM = 0,
    // bits of the run-time number of acquisitions
    parameter int ACQ_WIDTH = 16,
    // registers between the shared logic and the columns; they delay, and change no result
    parameter int BROADCAST_STAGES = 2,
    // rows of a group, which shares a coarse histogram
    parameter int GROUP_SIZE = 4,
    // candidates of a group
    parameter int LABELS = 5,
    // bits of their scores
    parameter int SCORE_BITS = 4,
    // bits of a leader's offset in the track phase, 0 for none
    parameter int OFFSET_BITS = 6,
    // bits of the leader's advantage
    parameter int ADVANTAGE_WIDTH = 7,
    // a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
    parameter int POINTER_SHIFT = 1,
    // 1: the rival has a pointer of its own
    parameter int RIVAL_MOVES = 1,
    // windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
    parameter int CELL_SHIFT = 9,
    // 1: a result has the position of the label that lost, too
    parameter int SECOND_TARGET = 0,
    // 1: candidates may begin from those that were used in the last frame (`prior_i`)
    parameter int PRIOR = 0,
    // columns that share an engine
    parameter int ENGINE_COLUMNS = 34,
    // 64ths of a frame that the coarse phase is recommended to take
    parameter int COARSE_SHARE = 14,
    // 64ths of a frame that the track phase is recommended to take
    parameter int TRACK_SHARE = 20,
