// The step generator of litexcnc at a speed that changes every 4096 clocks; `check` gathers its position.
module core (input clk, input load, input [31:0] clocks, output reg done, output reg [31:0] check);
  reg [31:0] left = 0;
  reg [31:0] random = 1;
  reg [15:0] at = 0;
  initial begin done = 0; check = 0; end
  wire step, direction;
  wire [71:0] position;
  wire [38:0] speed;
  stepgen axis (
    .speed_in({{3{random[31]}}, random, 12'b0}), .acceleration_in({8'b0, random[23:0]}), .write(at[11:0] == 20),
    .enable_in(1'b1), .reset_in(1'b0), .step_out(step), .dir_out(direction), .position_out(position),
    .speed_out(speed), .sys_clk(clk), .sys_rst(at < 4));
  always @(posedge clk) begin
    left <= load ? clocks : left - 1;
    done <= ~load & left == 1;
    at <= at == 65535 ? 4 : at + 1;
    if (at[11:0] == 0) random <= {random[30:0], 1'b0} ^ (random[31] ? 32'h04c11db7 : 32'b0);
    check <= {check[30:0], check[31]} ^ position[63:32] ^ position[31:0] ^ {speed[31:1], step ^ direction};
  end
endmodule
