// A memory that is cleared and then loaded from a file, and one whose upper half is loaded.
module loaded (input clk, input [3:0] at, output reg [7:0] whole, output reg [7:0] half, output [7:0] now);
  reg [7:0] table_of [0:15], upper [0:15];
  integer k;
  initial begin
    for (k = 0; k < 16; k = k + 1) begin table_of[k] = 0; upper[k] = k; end
    $readmemh("../table.hex", table_of);
    $readmemh("../table.hex", upper, 8, 15);
  end
  assign now = table_of[at];
  always @(posedge clk) begin whole <= table_of[at]; half <= upper[at]; end
endmodule
