// SPDX-License-Identifier: Apache-2.0
// Stand-in for the simulation model that an SRAM compiler delivers: single port, active-low controls, no byte
// write. CEN low selects the macro, WEN low writes; Q changes only on a read. Replace this file by the compiler's.
module sp_ram_160x14 (
    input             CLK,
    input             CEN,
    input             WEN,
    input      [ 7:0] A,
    input      [13:0] D,
    output reg [13:0] Q
);

  reg [13:0] mem[0:159];

  always @(posedge CLK) begin
    if (!CEN) begin
      if (!WEN) begin
        mem[A] <= D;
        Q <= 14'bx;
      end else begin
        Q <= mem[A];
      end
    end
  end

endmodule
