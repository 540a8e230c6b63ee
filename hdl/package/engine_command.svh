// SPDX-License-Identifier: Apache-2.0
// What engine_sequencer commands in a clock, with what each command means to who gets it. In which clocks it is given
// stands in the table in engine_sequencer; docs/reference/blocks/pool_control.md shows both, written by
// scripts/schedule.py from this file and from the table in simulation.
//
// Types of the compilation unit, included at the head of a file: Icarus Verilog 11 takes none of a package.
`ifndef ENGINE_COMMAND_SVH
`define ENGINE_COMMAND_SVH

// What the columns and the output do for the engines: at most one access of the columns' SRAMs a clock.
typedef struct packed {
  logic read_above;    // read the next word of bins of the group above
  logic read_own;      // read the next word of bins of the group
  logic read_below;    // read the next word of bins of the group below
  logic read_group;    // read the group's word, so that the pair's other column gets its own back
  logic write_group;   // write the group's word: its candidates and its background
  logic fetch_pixel;   // read the word of the pixel two steps on
  logic fetch_group;   // read the word of that pixel's group
  logic read_pair;     // read the words of two pixels done, so that the pair's other column gets its own back
  logic write_pair;    // write the first pointer words of these two pixels
  logic send;          // the engines' results go to the output
} column_command_t;

// To candidate_decoder.
typedef struct packed {
  logic capture_above;  // the line is a word of bins of the group above
  logic capture_own;    // the line is a word of bins of the group
  logic capture_below;  // the line is a word of bins of the group below
  logic fill;           // a pair sum enters the ring
  logic search;         // the ring turns, a pair a clock, a turn a candidate
  logic [4:0] pair;     // with fill the bin, with search the pair at the ring's head + 1
  logic first_label;    // with search: for the first candidate
  logic pooled;         // with search: over pooled sums
  logic candidate;      // the turn before has found its candidate
} decode_command_t;

// To label_chain.
typedef struct packed {
  logic begin_step;     // evidence and message are added
  logic spread;         // how far each label is behind the largest sum is known
  logic pass_label;     // a label of the next pixel gets its message, the same label of this pixel its belief
  logic [2:0] target;   // with pass_label two clocks later: the label of the next pixel
  logic advance;        // the next pixel becomes this one, the prepared one the next
  logic clear_message;  // with advance: the pixel that becomes this one begins the chain
} chain_command_t;

// To pool_engine.
typedef struct packed {
  logic decoding;       // with write_group, in all of decode: the engine's word is the group's
  logic deciding;       // with write_message, in all of decide: the message is decide's
  decode_command_t decode;
  logic take_pixel;     // the line is the word of the pixel to prepare, in the next clock that of its group
  logic odd_pixel;      // with take_pixel: the word's second pixel
  chain_command_t choose;
  chain_command_t decide;
  logic write_message;  // this pixel's message of the first pass goes to the scratch memory
  logic read_message;   // the message of the first pass comes back from the scratch memory
  logic take_choice;    // the two best labels of the pixel before are known: its first pointer word
  logic take_result;    // the better label of the pixel before is known: its result
  logic odd_result;     // with take_choice: the word's second pixel
} engine_command_t;

`endif
