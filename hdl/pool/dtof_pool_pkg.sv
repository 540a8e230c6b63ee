// SPDX-License-Identifier: Apache-2.0
// Types of poolPointer: the states of a frame, the commands that dtof_pool_sequencer gives in a clock, and the distance of a timestamp. The
// comment on a command is its meaning for the module that receives it. The table in dtof_pool_sequencer has the clocks of the commands;
// docs/reference/blocks/pool_control.md shows both, written by scripts/schedule.py from this file and from a simulation of the table.
//
// Modules import these types with `DTOF_TYPES_OF and `DTOF_TYPE of dtof_macros.svh. Cost: none.

// verilator lint_off TIMESCALEMOD
`default_nettype none

package dtof_pool_pkg;

  // States of dtof_pool_controller, with the same codes in the same order as dtof_pkg::state_t.
  typedef enum logic [2:0] {
    POOL_STATE_IDLE   = 3'd0,
    POOL_STATE_RESET  = 3'd1,
    POOL_STATE_COARSE = 3'd2,
    POOL_STATE_DECODE = 3'd3,
    POOL_STATE_TRACK  = 3'd4,
    POOL_STATE_CHOOSE = 3'd5,
    POOL_STATE_POINT  = 3'd6,
    POOL_STATE_DECIDE = 3'd7
  } pool_state_t;

  // Commands to the columns and the output: at most one access of the columns' SRAMs per clock.
  typedef struct packed {
    logic read_above;         // read the next bins of the group above
    logic read_own;           // read the next bins of the group
    logic read_below;         // read the next bins of the group below
    logic read_left;          // read the next bins of the group to the left
    logic read_right;         // read the next bins of the group to the right
    logic read_prior;         // read the group's word of the last frame
    logic read_group;         // read the group's word, so that the other group in the same SRAM word stays as it is
    logic write_group;        // write the group's word: its candidates and its background
    logic fetch_right_pixel;  // read the word of the pixel to the right of the one to be fetched
    logic fetch_right_group;  // read the word of that pixel's group
    logic fetch_pixel;        // read the word of the pixel to be fetched
    logic fetch_group;        // read the word of that pixel's group
    logic read_pair;          // read the words of two finished pixels, so that the words of the pair's other column stay as they are
    logic write_pair;         // write the first pointer words of these two pixels
    logic read_used;          // read the word of a finished group, so that its candidates stay as they are
    logic write_used;         // write which candidates of this group are used
    logic send;               // the output takes the engines' results
  } pool_column_command_t;

  // To dtof_pool_candidate_decoder.
  typedef struct packed {
    logic capture_above;  // the line has bins of the group above
    logic capture_own;    // the line has bins of the group
    logic capture_below;  // the line has bins of the group below
    logic capture_left;   // the line has bins of the group to the left
    logic capture_right;  // the line has bins of the group to the right
    logic count_own;      // a bin of the group itself is added to its octet
    logic [4:0] own_bin;  // with count_own: number of the bin
    logic fill;           // a pair sum enters the ring
    logic search;         // the ring turns: one pair per clock, one turn per candidate
    logic [4:0] pair;     // with fill the bin, with search the pair at the ring's head + 1
    logic first_label;    // with search: for the first candidate
    logic candidate;      // the candidate of the turn before is complete
    logic take_prior;     // the line has the group's word of the last frame, or 0
    logic [1:0] missing;  // number of neighbours above, below and to the left that the group lacks
  } pool_decode_command_t;

  // To dtof_label_chain.
  typedef struct packed {
    logic begin_step;     // registers the sums of evidence and message
    logic spread;         // registers how far each label is below the largest sum
    logic pass_label;     // a label of the next pixel gets its message, the same label of this pixel its belief
    logic [2:0] target;   // with pass_label two clocks later: number of the label
    logic advance;        // the next pixel becomes this pixel, the prepared pixel becomes the next
    logic clear_message;  // with advance: the pixel that becomes this pixel is the first of the chain
  } chain_command_t;

  // To dtof_beside_evidence.
  typedef struct packed {
    logic take_right_pixel;  // the line has the word of the pixel to the right
    logic rank;              // the next candidate of the pixel to the right is ranked
    logic first_rank;        // with rank: first candidate; the line has the word of its group
    logic take_ranks;        // the best two candidates of the pixel to the right are known
    logic compare;           // the next candidate of the prepared pixel is compared with the candidates of the neighbouring columns
    logic late_rank;         // with rank: this candidate pays LABEL_COST
    logic late_compare;      // with compare: this candidate pays LABEL_COST
    logic has_left;          // a column to the left exists
  } beside_command_t;

  // To dtof_pool_engine.
  typedef struct packed {
    logic decoding;       // high during decode: the decoder works, and the engine's word is the group's word
    logic choosing;       // high during choose: its chain works, and the engine's word is two first pointer words, otherwise 0
    logic deciding;       // high during decide: its chain works, and the message is that of decide
    logic giving_used;    // with write_used, during its whole step: the engine's word is the used candidates
    logic back;           // high during the second pass of a chain
    pool_decode_command_t decode;
    beside_command_t beside;
    logic take_pixel;     // the line has the word of the pixel to prepare, in the next clock the word of its group
    logic odd_pixel;      // with take_pixel and take_right_pixel: the word's second pixel
    chain_command_t choose;
    chain_command_t decide;
    logic write_scratch;  // the scratch memory stores the message of the first pass, or the best label of this column
    logic read_scratch;   // the scratch memory reads the message of the first pass, or the best label of the column to the left
    logic take_choice;    // the best two labels of the pixel before are known; its best label is a used candidate of its group
    logic take_word;      // a pixel's first pointer word is known
    logic odd_word;       // with take_word: the word's second pixel
    logic take_used;      // the line has the word of the pixel's group: candidates that the column to the left has used
    logic next_group;     // the group before is finished: the pixel before is the first of its group, or the column has ended
    logic take_position;  // the best label of the pixel before is known, or the column has ended
    logic has_position;   // with take_position: the best label is known
    logic take_distances; // the position in the centre is compared with the positions above, below and to the left
    logic take_result;    // the result of the winner in the centre is known
  } pool_engine_command_t;

  // Output of dtof_pixel_distance. All fields are 0 without a timestamp.
  typedef struct packed {
    logic offset_up;     // track: the timestamp is above the leader's position, and near
    logic offset_down;   // track: the timestamp is below, and near
    logic reach;         // point: the timestamp is near enough to move the pointer
    logic up;            // point: the timestamp is above the pointer
    logic [2:0] weight;  // point: weight of the timestamp, by its distance
    logic [3:0] gear;    // point: log2 of the pointer's step
    logic hit;           // point: the timestamp is in the leader's window
    logic rival_hit;     // point: the timestamp is in the rival's window
    logic rival_up;      // point: the timestamp is above the rival, and near
    logic rival_down;    // point: the timestamp is below the rival, and near
  } pixel_distance_t;

endpackage

`default_nettype wire
