// Words that depend on themselves in other bits alone: every bit on those below it, or on those above it.
module loops (
  input clk, input [7:0] a, input [7:0] b, input signed [15:0] c, input [2:0] by,
  output [7:0] prefix, output [7:0] y, output [3:0] z, output signed [15:0] down, output [5:0] product,
  output [7:0] negated, output [15:0] up, output reg [15:0] last);
  assign prefix = {prefix[6:0], 1'b0} + a;
  assign y = {z, 4'd0} + a;
  assign z = y[3:0] - b[3:0];
  assign down = $signed({c[15], down[15:1]}) >>> by;
  assign product = {product[4:0], 1'b1} * c[5:0];
  assign negated = -{negated[6:0], a[0]};
  assign up = {up[14:0], a[0]} << by;
  initial last = 0;
  always @(posedge clk) last <= last + (product ^ up) - {y, prefix};
endmodule
