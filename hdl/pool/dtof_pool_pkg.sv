// SPDX-License-Identifier: Apache-2.0
// Types of poolPointer: the states of its frame, the commands of dtof_pool_sequencer in a clock, with the meaning of each command for the
// module that gets it, and the place of a timestamp. The table in dtof_pool_sequencer has the clocks in which commands are given;
// docs/reference/blocks/pool_control.md shows both, written by scripts/schedule.py from this file and from the table in simulation.
//
// `DTOF_TYPES_OF and `DTOF_TYPE of dtof_macros.svh give a module these types.

// verilator lint_off TIMESCALEMOD
`default_nettype none

package dtof_pool_pkg;

  // States of dtof_pool_controller, with the codes of dtof_pkg::state_t in their order.
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

  // What the columns and the output do for the engines: at most one access of the columns' SRAMs a clock.
  typedef struct packed {
    logic read_above;         // read the next bins of the group above
    logic read_own;           // read the next bins of the group
    logic read_below;         // read the next bins of the group below
    logic read_left;          // read the next bins of the group to the left
    logic read_right;         // read the next bins of the group to the right
    logic read_prior;         // read the group's word of the last frame
    logic read_group;         // read the group's word, so that the group beside it in the word stays as it is
    logic write_group;        // write the group's word: its candidates and its background
    logic fetch_right_pixel;  // read the word of the pixel to the right of the one to be fetched
    logic fetch_right_group;  // read the word of that pixel's group
    logic fetch_pixel;        // read the word of the pixel to be fetched
    logic fetch_group;        // read the word of that pixel's group
    logic read_pair;          // read the words of two pixels done, so that the pair's other column keeps its own
    logic write_pair;         // write the first pointer words of these two pixels
    logic read_used;          // read the word of a group done, so that its candidates stay as they are
    logic write_used;         // write which of its candidates are used
    logic send;               // the engines' results go to the output
  } pool_column_command_t;

  // To dtof_pool_candidate_decoder.
  typedef struct packed {
    logic capture_above;  // the line has bins of the group above
    logic capture_own;    // the line has bins of the group
    logic capture_below;  // the line has bins of the group below
    logic capture_left;   // the line has bins of the group to the left
    logic capture_right;  // the line has bins of the group to the right
    logic count_own;      // a bin of the group itself is added to its octet
    logic [4:0] own_bin;  // with count_own: which bin
    logic fill;           // a pair sum enters the ring
    logic search;         // the ring turns, a pair a clock, a turn a candidate
    logic [4:0] pair;     // with fill the bin, with search the pair at the ring's head + 1
    logic first_label;    // with search: for the first candidate
    logic candidate;      // the turn before has found its candidate
    logic take_prior;     // the line is the group's word of the last frame, or 0
    logic [1:0] missing;  // neighbours above, below and to the left that the group does not have
  } pool_decode_command_t;

  // To dtof_label_chain.
  typedef struct packed {
    logic begin_step;     // evidence and message are added
    logic spread;         // how far each label is behind the largest sum is known
    logic pass_label;     // a label of the next pixel gets its message, the same label of this pixel its belief
    logic [2:0] target;   // with pass_label two clocks later: the label of the next pixel
    logic advance;        // the next pixel becomes this one, the prepared one the next
    logic clear_message;  // with advance: the pixel that becomes this one begins the chain
  } chain_command_t;

  // To dtof_beside_evidence.
  typedef struct packed {
    logic take_right_pixel;  // the line is the word of the pixel to the right
    logic rank;              // the next candidate of the pixel to the right is ranked
    logic first_rank;        // with rank: the first candidate, while the line is the word of its group
    logic take_ranks;        // the best two candidates of the pixel to the right are known
    logic compare;           // the next candidate of the pixel prepared is compared with those of the columns beside
    logic late_rank;         // with rank: this candidate pays for being a late one
    logic late_compare;      // with compare: this candidate pays for being a late one
    logic has_left;          // there is a column to the left
  } beside_command_t;

  // To dtof_pool_engine.
  typedef struct packed {
    logic decoding;       // in all of decode: the decoder is at work, and the engine's word is the group's
    logic choosing;       // in all of choose: its chain is at work, and the engine's word is two first pointer words, otherwise 0
    logic deciding;       // in all of decide: its chain is at work, and the message is decide's
    logic giving_used;    // with write_used, in all of its step: the engine's word is which candidates are used
    logic back;           // the second pass of a chain
    pool_decode_command_t decode;
    beside_command_t beside;
    logic take_pixel;     // the line is the word of the pixel to prepare, in the next clock that of its group
    logic odd_pixel;      // with take_pixel and take_right_pixel: the word's second pixel
    chain_command_t choose;
    chain_command_t decide;
    logic write_scratch;  // this pixel's message of the first pass, or where its best label is, goes to the scratch memory
    logic read_scratch;   // the message of the first pass, or where the best label to the left is, comes back
    logic take_choice;    // the two best labels of the pixel before are known: which of its group's candidates it uses
    logic take_word;      // a pixel's first pointer word is known
    logic odd_word;       // with take_word: the word's second pixel
    logic take_used;      // the line is the word of the pixel's group: which candidates the column to the left has used
    logic next_group;     // the group before is done; the pixel before is its group's first one, or the column has ended
    logic take_position;  // the best label of the pixel before is known, or the column has ended
    logic has_position;   // with take_position: it is known
    logic take_distances; // the position in the middle is compared with those above, below and to the left
    logic take_result;    // the result of the winner in the middle is known
  } pool_engine_command_t;

  // From dtof_pixel_distance: where a timestamp lies, for the word of its pixel. All are 0 without a timestamp.
  typedef struct packed {
    logic offset_up;     // track: the timestamp lies above the leader's position, and near
    logic offset_down;   // track: it lies below, and near
    logic reach;         // point: it lies near enough to move the pointer
    logic up;            // point: it lies above the pointer
    logic [2:0] weight;  // point: its weight, by its distance
    logic [3:0] gear;    // point: how far the pointer moves, as a power of two
    logic hit;           // point: it lies in the leader's window
    logic rival_hit;     // point: it lies in the rival's window
    logic rival_up;      // point: it lies above the rival, and near
    logic rival_down;    // point: it lies below the rival, and near
  } pixel_distance_t;

endpackage

`default_nettype wire
