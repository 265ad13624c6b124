// A sum whose increment is at most 1 by assumption: it loses its first carry at clock 15, and not before.
module assumed(input clk, input [3:0] i, output reg [3:0] sum);
  initial sum = 0;
  always @(posedge clk) begin
    sum <= sum + i;
    assume (i < 2);
  end
endmodule
