// Words of more than 64 bits: an accumulator of 87 bits with a signed input, ports of 128, 70 and 65 bits, a memory of 100.
module wide #(parameter WIDTH = 87) (
  input clk, input rst, input load, input signed [69:0] din, input [127:0] key, input [4:0] at, input we,
  output reg signed [WIDTH-1:0] acc, output [127:0] mixed, output [64:0] top, output reg [99:0] word,
  output above, output signed [129:0] product, output signed [66:0] low);
  reg [127:0] state;
  reg [99:0] memory [0:31];
  wire signed [WIDTH-1:0] next = acc + $signed({din, 14'd0});
  assign mixed = (state ^ key) + {key[63:0], key[127:64]};
  assign top = mixed[127:63];
  assign above = acc > din;
  assign product = $signed(acc[79:0]) * $signed(din[49:0]);
  part u1 (.clk(clk), .value(mixed[90:1]), .low(low));
  integer i;
  initial begin
    acc = 0; state = 0; word = 0;
  end
  initial for (i = 0; i < 32; i = i + 1) memory[i] = 100'd0;
  always @(posedge clk) begin
    if (rst) begin
      acc <= 0; state <= 128'h0123456789abcdef_fedcba9876543210;
    end else begin
      acc <= load ? {{17{din[69]}}, din} : next;
      state <= {state[126:0], state[127] ^ state[3]} - key;
    end
    word <= memory[at];
    if (we) memory[at ^ 5'd3] <= mixed[113:14];
  end
endmodule

module part (input clk, input [89:0] value, output signed [66:0] low);
  reg [89:0] last = 0;
  assign low = $signed(last[66:0]) >>> 3;
  always @(posedge clk) last <= value - {value[10:0], 77'd5};
endmodule
