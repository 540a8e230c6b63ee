// SPDX-License-Identifier: Apache-2.0
// Tests a memory with March C- while run_i is high: writes and reads every word in both orders of addresses, and compares what it reads.
//
// Equation: March C- (van de Goor 1993), with D a background and N its complement:
//   up(write D); up(read D, write N); up(read N, write D); down(read D, write N); down(read N, write D); up(read D).
// It is done with the background of zeros, and with one for each bit of a bit's number: bit i of background b is bit b - 1 of i. So every two
// bits of a word differ in one background. The test finds stuck bits, transition faults, faults of the address decoder, and coupling faults
// between two bits. It does not use both ports of a memory in one clock.
// Schedule: one access per clock; the word that is read in clock n is compared in clock n + 1. run_i low resets the test.
// Latency: (10 DEPTH) x ($clog2(WIDTH) + 1) + 1 clocks, then done_o is high, and good_o is the verdict.
// Cost: for 160 words of 14 bits 32 flip-flops and 167 gates, as Yosys 0.23 synth counts them.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_march_test #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic                  run_i,
    // to the memory, whose data follow a read one clock later
    output logic                  en_o,
    output logic                  we_o,
    output logic [ADDR_WIDTH-1:0] addr_o,
    output logic [     WIDTH-1:0] wdata_o,
    input  logic [     WIDTH-1:0] rdata_i,
    output logic                  done_o,
    output logic                  good_o   // no word was wrong until now
);

  localparam int BACKGROUNDS = (WIDTH > 1) ? $clog2(WIDTH) + 1 : 1;
  localparam int BACKGROUND_WIDTH = (BACKGROUNDS > 1) ? $clog2(BACKGROUNDS) : 1;
  localparam logic [ADDR_WIDTH-1:0] LAST_ADDRESS = ADDR_WIDTH'(DEPTH - 1);
  localparam logic [BACKGROUND_WIDTH-1:0] LAST_BACKGROUND = BACKGROUND_WIDTH'(BACKGROUNDS - 1);
  localparam logic [2:0] LAST_ELEMENT = 3'd5;

  logic [2:0] element_q;  // 0: up(write D), and so on
  logic [ADDR_WIDTH-1:0] address_q;
  logic [BACKGROUND_WIDTH-1:0] background_q;
  logic second_q;  // the second access to the word
  logic ended_q, compared_q, good_q;
  logic complemented_q;  // the word that is compared is N
  logic reads, both, down, next_down, moves, ends;
  logic [WIDTH-1:0] background, wanted;

  assign both = (element_q != 3'd0) && (element_q != LAST_ELEMENT);
  assign reads = both ? !second_q : (element_q == LAST_ELEMENT);
  assign down = (element_q == 3'd3) || (element_q == 3'd4);
  assign next_down = (element_q == 3'd2) || (element_q == 3'd3);
  assign moves = !both || second_q;
  assign ends = moves && (address_q == (down ? '0 : LAST_ADDRESS));

  // The background of the present accesses, and that of the word which is compared: it changes only behind an element that writes.
  genvar i;
  generate
    for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
      localparam logic [31:0] NUMBER = 32'(i) << 1;  // background 0 has zeros
      assign background[i] = NUMBER[5'(background_q)];
    end
  endgenerate

  assign en_o = run_i && !ended_q;
  assign we_o = !reads;
  assign addr_o = address_q;
  assign wdata_o = ((element_q == 3'd1) || (element_q == 3'd3)) ? ~background : background;

  logic [WIDTH-1:0] compared_background_q;
  assign wanted = complemented_q ? ~compared_background_q : compared_background_q;

  always_ff @(posedge clk_i) begin
    if (!run_i) begin
      element_q <= '0;
      address_q <= '0;
      background_q <= '0;
      second_q <= 1'b0;
      ended_q <= 1'b0;
      compared_q <= 1'b0;
      good_q <= 1'b1;
    end else begin
      compared_q <= en_o && reads;
      second_q <= both && !second_q;
      if (compared_q) begin
        if (rdata_i == wanted) begin
        end else begin
          good_q <= 1'b0;  // in a simulation also for an unknown bit
        end
      end
      if (!ended_q) begin
        if (ends) begin
          element_q <= (element_q == LAST_ELEMENT) ? '0 : element_q + 1'b1;
          address_q <= next_down ? LAST_ADDRESS : '0;
          if (element_q == LAST_ELEMENT) begin
            background_q <= background_q + 1'b1;
            ended_q <= (background_q == LAST_BACKGROUND);
          end
        end else if (moves) begin
          address_q <= down ? address_q - 1'b1 : address_q + 1'b1;
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    complemented_q <= (element_q == 3'd2) || (element_q == 3'd4);
    compared_background_q <= background;
  end

  assign done_o = run_i && ended_q && !compared_q;
  assign good_o = good_q;

endmodule

`default_nettype wire
