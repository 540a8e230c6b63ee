// SPDX-License-Identifier: Apache-2.0
// Constants and functions of the arrays: numbers of the read-outs (dtof_readouts.svh), sizes that follow from a read-out's parameters
// (docs/reference/readouts.md), and latencies of modules. Cost: none; everything is evaluated at elaboration.

// verilator lint_off TIMESCALEMOD
`default_nettype none

package dtof_pkg;

  // Values of state_o of dtof_array: thesis Fig. 4.3 (IDLE, RESET, M3 = EXECUTE, M4/M5 = RESULT) and Fig. 4.8.
  typedef enum logic [2:0] {
    STATE_IDLE  = 3'd0,
    STATE_RESET = 3'd1,
    STATE_M0    = 3'd2,
    STATE_M1    = 3'd3,
    STATE_M2    = 3'd4,
    STATE_M3    = 3'd5,
    STATE_M4    = 3'd6,
    STATE_M5    = 3'd7
  } state_t;

  // Bits of error_o (common/dtof_array_errors.sv).
  localparam int ERROR_UNDERRUN = 0;
  localparam int ERROR_START_IGNORED = 1;
  localparam int ERROR_ILLEGAL_SCHEDULE = 2;
  localparam int ERROR_WIDTH = 3;

  // Width of the side band from the top to every SRAM macro and back. Define DTOF_SRAM_CFG_WIDTH for SRAMs that need more bits.
`ifdef DTOF_SRAM_CFG_WIDTH
  localparam int SRAM_CFG_WIDTH = `DTOF_SRAM_CFG_WIDTH;
`else
  localparam int SRAM_CFG_WIDTH = 1;
`endif

  // Latencies of modules in clocks, from port to port, for the sequencers that drive the modules.
  localparam int HISTOGRAM_WRITE_STAGE = 5;          // dtof_histogram_builder: a timestamp of T0 is written at T5
  localparam int POOL_PAIR_READ_CLOCKS = 2;          // dtof_pool_pair: from read_i to word_o, and to a write with it
  localparam int POOL_SCRATCH_PARITIES = 2;          // parity bits of a word of dtof_pool_engine's scratch memory
  localparam int POOL_PARITY_CLOCKS = 3;             // dtof_pool_word_parity: from an access of the SRAM to its parity
  localparam int POOL_LINE_CLOCKS = 1;               // dtof_pool_line: from the pairs' words to the engine's line_i
  localparam int POOL_ENGINE_LINE_CLOCKS = 1;        // dtof_pool_engine: from line_i to the line that its commands use, except in decode
  localparam int POOL_ENGINE_MESSAGE_CLOCKS = 1;     // dtof_pool_engine: from read_scratch to the message
  localparam int POOL_ENGINE_RESULT_CLOCKS = 1;      // dtof_pool_engine: from take_result to result_o
  localparam int POOL_DECODER_CANDIDATE_CLOCKS = 2;  // dtof_pool_candidate_decoder: from a turn's last pair to its candidate
  localparam int POOL_CHAIN_SPREAD_CLOCKS = 3;       // dtof_label_chain: from begin_step to spread; then the labels pass
  localparam int POOL_CHAIN_TARGET_CLOCKS = 2;       // dtof_label_chain: from a label's target to its pass_label
  localparam int POOL_CHAIN_BELIEF_CLOCKS = 2;       // dtof_label_chain: from the last pass_label to the two best beliefs

  localparam int POOL_DECODER_TEMPLATE_CLOCKS = 1;  // dtof_pool_candidate_decoder: from capture_above to template_i of bin 0
  localparam int POOL_DECODER_FILL_CLOCKS = 6;      // dtof_pool_candidate_decoder: from capture_above to the first pair sum
  localparam int POOL_DECODER_SIGNIFICANCE_CLOCKS = 3;  // dtof_pool_candidate_decoder: from a candidate to its significance
  localparam int POOL_DECODER_OWN_CLOCKS = 2;       // dtof_pool_candidate_decoder: from capture_above to count_own
  localparam int POOL_ENGINE_DISTANCE_CLOCKS = 1;   // dtof_pool_engine: from take_position to take_distances
  localparam int POOL_ENGINE_SMOOTH_CLOCKS = 2;     // dtof_pool_engine: from take_distances to take_word and take_result

  function automatic int max_of(input int a, input int b);
    max_of = (a > b) ? a : b;
  endfunction

  function automatic int min_of(input int a, input int b);
    min_of = (a < b) ? a : b;
  endfunction

  // Bits that index `count` things, at least one.
  function automatic int index_width(input int count);
    index_width = (count <= 2) ? 1 : $clog2(count);
  endfunction

  `include "dtof_readouts.svh"

  // Low bits that step k (0 to 2) of three steps leaves undecided; k = -1: all of them.
  function automatic int step_shift(input int np, input int k);
    step_shift = max_of(np - 3 * (k + 1), 0);
  endfunction

  // Bits of the coarse peak that measurement 2 needs.
  function automatic int peak_width(input int readout, input int np, input int nb);
    peak_width = (readout == READOUT_THREESTEPS) ? np - step_shift(np, 2) : nb;
  endfunction

  // Addresses of a pixel's scan in M4: its bins, and the clocks of the computation after them.
  function automatic int final_addresses(input int readout, input int np, input int nb, input int fraction_bits);
    final_addresses = (1 << scan_width(readout, np, nb)) + decode_clocks(readout, np, nb, fraction_bits);
  endfunction

  // Bits of a scan's address.
  function automatic int scan_address_width(input int readout, input int np, input int nb, input int fraction_bits);
    scan_address_width = max_of(bin_width(readout, np, nb), index_width(final_addresses(readout, np, nb, fraction_bits)));
  endfunction

  // Bits of a pointer's full step in units of 2^-FRACTION_BITS bin.
  function automatic int step_width(input int pointer_step, input int fraction_bits);
    step_width = $clog2(pointer_step + 1) + fraction_bits;
  endfunction

  // Bits of {code, fraction, confidence}.
  function automatic int result_width(input int readout, input int np, input int count_width,
                                      input int fraction_bits, input int pointer_confidence_width);
    result_width = np + fraction_width(readout, fraction_bits)
        + confidence_width(readout, count_width, pointer_confidence_width);
  endfunction

  // poolPointer (docs/reference/poolpointer.md). Positions have 16 bits for the whole range; a cell is 512 of them.
  localparam int POOL_COARSE_BINS = 32;
  localparam int POOL_CELL_WIDTH = 7;
  localparam int POOL_BACKGROUND_WIDTH = 6;  // 0 .. 39
  localparam int POOL_FEWEST_BACKGROUND_BITS = 4;  // bits that a group's word stores at least
  localparam int POOL_RIVAL_WIDTH = 7;  // a cell
  localparam int POOL_SIGNIFICANCE_WIDTH = 3;         // bits of a candidate's significance, at most
  localparam int POOL_TEMPLATE_WIDTH = 8;  // bits of an entry of TEMPLATE
  localparam int POOL_SIGNIFICANCE_OFFSET_WIDTH = 5;  // correction for long frames, 0 .. 17
  localparam int POOL_SKY_WIDTH = 4;                  // background / 4, which selects the statistics of a sky's margins
  localparam int POOL_BINS_PER_LINE = 8;  // coarse bins that an engine reads at once
  localparam int POOL_LINE_PAIRS = 4;      // pairs of columns whose words share one register on the way to the engine (dtof_pool_line)
  localparam int POOL_SWEEP_WIDTH = 6;     // every 2^6-th acquisition of the coarse phase is a sweep
  localparam int POOL_ACQUISITION_WIDTH = 9;  // low bits of an acquisition's number, on which sweeps, dither and thinning depend
  localparam int POOL_THINNING_WIDTH = 3;     // eighths of the range: how many of them an acquisition leaves out, at most
  // Scores are thinned in groups whose background is at least 4: one of its highest four bits is 1, and a group's word stores these.
  localparam int POOL_THINNED_BITS = 4;
  // Bits of pool_engine_command_t (dtof_pool_pkg), as a number because Yosys 0.23 has no $bits of a type, and Icarus 11 none of a
  // variable of such a type. Every lint reports a wrong number.
  localparam int POOL_COMMAND_WIDTH = 65;
  localparam int POOL_CHOOSE_PENALTY_WIDTH = 4;  // 2 + (5 * 39 >> 4) at most
  localparam int POOL_DECIDE_PENALTY_WIDTH = 2;
  localparam int POOL_EVIDENCE_WIDTH = 6;  // -21 .. 15: a score minus LABEL_COST, LEFT_COST and RIGHT_LIMIT

  // Bits of a pointer: the whole range, or half a coarse bin to either side of a candidate.
  function automatic int pool_pointer_width(input int pointer_shift, input int rival_moves);
    pool_pointer_width = ((rival_moves != 0) ? 16 : 12) - pointer_shift;
  endfunction

  // Bits of a pixel's word in the track phase: scores, leader, offset.
  function automatic int pool_track_width(input int labels, input int score_bits, input int offset_bits);
    pool_track_width = labels * score_bits + ((offset_bits > 0) ? offset_bits + index_width(labels) : 0);
  endfunction

  // Bits of a pixel's word in the pointer phase: advantage, rival, pointer.
  function automatic int pool_point_width(input int labels, input int advantage_width, input int pointer_shift,
                                          input int rival_moves);
    pool_point_width = advantage_width + pool_pointer_width(pointer_shift, rival_moves)
        + ((rival_moves != 0) ? POOL_RIVAL_WIDTH : 2 * index_width(labels));
  endfunction

  // Bits of a pixel's word.
  function automatic int pool_pixel_width(input int labels, input int score_bits, input int offset_bits,
                                           input int advantage_width, input int pointer_shift, input int rival_moves);
    pool_pixel_width = max_of(pool_track_width(labels, score_bits, offset_bits),
                               pool_point_width(labels, advantage_width, pointer_shift, rival_moves));
  endfunction

  // Number of bits of a group's background that its word stores, from the highest bit: as many as fit two pixels' words beside the candidates.
  function automatic int pool_background_width(input int labels, input int pixel_width);
    pool_background_width = 2 * pixel_width - POOL_CELL_WIDTH * labels;
    if (pool_background_width < POOL_FEWEST_BACKGROUND_BITS) pool_background_width = POOL_FEWEST_BACKGROUND_BITS;
    if (pool_background_width > POOL_BACKGROUND_WIDTH) pool_background_width = POOL_BACKGROUND_WIDTH;
  endfunction

  // Number of bits of each candidate's significance that a group's word stores, 3, 2 or 0: as many as fit two pixels' words beside
  // candidates, background, with PRIOR = 1 the used candidates, and the flag of a tilted background.
  function automatic int pool_significance_width(input int labels, input int pixel_width, input int advantage_width,
                                                 input int rival_moves, input int prior);
    pool_significance_width = (2 * pixel_width - pool_group_width(labels, pixel_width) - ((prior != 0) ? labels : 0) - 1) / labels;
    if (pool_significance_width > POOL_SIGNIFICANCE_WIDTH) pool_significance_width = POOL_SIGNIFICANCE_WIDTH;
    if (pool_significance_width < 2 || advantage_width != 7 || rival_moves == 0) pool_significance_width = 0;
  endfunction

  // Bits of a group's word: candidates and background.
  function automatic int pool_group_width(input int labels, input int pixel_width);
    pool_group_width = POOL_CELL_WIDTH * labels + pool_background_width(labels, pixel_width);
  endfunction

  // log2 of the unit of TEMPLATE, in counts of a bin's sum over seven histograms. The largest entry is more than the largest sum.
  function automatic int pool_template_shift(input int count_width);
    pool_template_shift = max_of(count_width - 5, 0);
  endfunction

  // Bits of half an SRAM word of a pair of columns: two pixels of a column, or a group.
  function automatic int pool_half_width(input int labels, input int score_bits, input int offset_bits,
                                          input int advantage_width, input int pointer_shift, input int rival_moves);
    pool_half_width = pool_pixel_width(labels, score_bits, offset_bits, advantage_width, pointer_shift, rival_moves);
    pool_half_width = max_of(2 * pool_half_width, pool_group_width(labels, pool_half_width));
  endfunction

  // Halves of such a word that POOL_BINS_PER_LINE coarse bins and one more bit need, 1 or 2.
  function automatic int pool_line_halves(input int half_width, input int count_width);
    pool_line_halves = (POOL_BINS_PER_LINE * count_width < half_width) ? 1 : 2;
  endfunction

  // log2 of the parts of a group's coarse bins; each part is a word.
  function automatic int pool_part_width(input int line_halves);
    pool_part_width = (line_halves == 1) ? 1 : 2;
  endfunction

  // Bits of sent_t (dtof_pool_commands.svh); `pairs` is that of a full and of the last engine.
  function automatic int pool_sent_width(input int np, input int address_width, input int row_width, input int pairs,
                                         input int part_width);
    pool_sent_width = 2 * np + address_width + row_width + pairs + part_width + POOL_COMMAND_WIDTH
        + POOL_SIGNIFICANCE_OFFSET_WIDTH + POOL_TEMPLATE_WIDTH + POOL_THINNING_WIDTH + 34;
  endfunction

  // Bits of a result's confidence: the advantage and both neighbours' penalties.
  function automatic int pool_confidence_width(input int advantage_width);
    pool_confidence_width = $clog2((1 << advantage_width) + 16);
  endfunction

  // Whether a raw histogram exists. It does not if a scan stores a word per pixel, the best of several histograms.
  function automatic bit has_whole_histogram(input int readout, input int np, input int nb);
    has_whole_histogram = has_histogram(readout)
        && (!has_word(readout) || is_word_read_ahead(readout) || coarse_passes(readout, np, nb) == 0);
  endfunction

  // Bins of a raw histogram: of the final pass, or of the pass before if timestamps change a word in the final pass.
  function automatic int raw_bins(input int readout, input int np, input int nb);
    raw_bins = 1 << (is_word_moved(readout) ? bin_width(readout, np, nb) : scan_width(readout, np, nb));
  endfunction

  // Bits of command_t (dtof_column_commands.svh).
  function automatic int command_width(input int readout, input int np, input int nb, input int pixels, input int pointer_step,
                                       input int fraction_bits);
    command_width = 2 * np + index_width(coarse_passes(readout, np, nb) + 1) + 5 * index_width(pixels) + 2 * bin_width(readout, np, nb)
        + step_width(pointer_step, fraction_width(readout, fraction_bits)) + scan_address_width(readout, np, nb, fraction_bits) + 21;
  endfunction

  // Bits of the confidence in a result of a pointer read-out; the field has a count in a raw histogram.
  function automatic int kept_confidence_width(input int pointer_confidence_width, input int count_width,
                                               input int raw_histogram);
    kept_confidence_width = (raw_histogram != 0) ? max_of(pointer_confidence_width, count_width)
        : pointer_confidence_width;
  endfunction

  // Bits of a result: one position or two, and the confidence.
  function automatic int pool_result_width(input int advantage_width, input int second_target);
    pool_result_width = ((second_target != 0) ? 32 : 16) + pool_confidence_width(advantage_width);
  endfunction

  // Bits of an amplitude, which is at most 688 if an advantage has 7 bits, and at most 72 if it has 4.
  function automatic int pool_amplitude_width(input int advantage_width);
    pool_amplitude_width = advantage_width + 3;
  endfunction

  // Bits of {ambient, amplitude} in a result; 0 without AMPLITUDE.
  function automatic int pool_light_width(input int advantage_width, input int amplitude);
    pool_light_width = (amplitude != 0) ? POOL_BACKGROUND_WIDTH + pool_amplitude_width(advantage_width) : 0;
  endfunction

  // The counts that an advantage stands for. It counts every hit below half of its range, every fourth below three quarters, and every
  // sixteenth above.
  function automatic logic [9:0] pool_amplitude(input int advantage_width, input logic [6:0] advantage);
    logic [9:0] counts, half;
    counts = 10'(advantage);
    half = 10'd1 << (advantage_width - 1);
    pool_amplitude = counts;
    if (counts >= half + (half >> 1)) pool_amplitude = ((counts - half - (half >> 1)) << 4) + half + (half << 1);
    else if (counts >= half) pool_amplitude = ((counts - half) << 2) + half;
  endfunction

endpackage

`default_nettype wire
