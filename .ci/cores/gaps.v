// What has no value in Verilog: the registers are x after an edge at which they take a quotient by 0 or a word outside of a
// memory, and at no other.
module gaps (
  input clk, input rst, input en, input signed [2:0] a, input signed [2:0] b, input [3:0] at, input [3:0] to, input we,
  output reg signed [2:0] quotient, output reg [2:0] rest, output reg [7:0] word, output reg [7:0] later,
  output reg [3:0] guarded);
  reg [7:0] ram [2:11];
  reg [7:0] full [0:15];
  integer i;
  initial for (i = 2; i < 12; i = i + 1) ram[i] = i;
  initial for (i = 0; i < 16; i = i + 1) full[i] = i;
  always @(posedge clk) begin
    if (en) quotient <= a / b;
    rest <= $unsigned(a) % $unsigned(b);
    if (!en) word <= ram[at];
    later <= full[at] + 1;
    guarded <= b == 0 ? 0 : a / b;
    if (we) begin ram[to] <= a; full[to] <= b; end
  end
  initial begin quotient = 0; rest = 0; word = 0; later = 0; guarded = 0; end
endmodule
