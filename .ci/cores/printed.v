// Texts of every form that a run prints: numbers in all bases, signed and wide, characters, several at one edge.
module printed #(parameter BITS = 70) (input clk, input rst, input [BITS-1:0] wide, input signed [11:0] few, input [7:0] letter);
  reg signed [11:0] sum;
  reg [BITS-1:0] last;
  initial $display("begin {%0d}", BITS);
  always @(posedge clk)
    if (rst) begin
      sum <= 0;
      last <= 0;
    end else begin
      sum <= sum + few;
      last <= wide;
      $display("d %d %0d %6d %-6d| %06d %+d", sum, few, few, few, few, few);
      $display("h %h %0h %x b %b o %o %0o", wide, last, sum, few, sum, letter);
      if (few[0]) $write("w %d %d\n", wide, wide - last);
      if (letter[7:5] == 2) $display("c %c s %s {%d}", letter, {letter, 8'h21}, letter);
    end
endmodule
