// A PicoRV32 with 1 KiB of memory, which holds its program: it runs for `clocks` clocks, and `check` gathers what it stores.
module core (input clk, input load, input [31:0] clocks, output reg done, output reg [31:0] check);
  reg [31:0] left = 0;
  reg [2:0] begun = 0;
  wire resetn = begun == 7;
  reg [31:0] memory [0:255];
  initial $readmemh("program.hex", memory);
  initial begin done = 0; check = 0; end
  wire valid;
  wire [31:0] address, data;
  wire [3:0] lanes;
  reg ready = 0;
  reg [31:0] word = 0;
  picorv32 cpu (
    .clk(clk), .resetn(resetn), .mem_valid(valid), .mem_ready(ready), .mem_addr(address), .mem_wdata(data),
    .mem_wstrb(lanes), .mem_rdata(word), .pcpi_wr(1'b0), .pcpi_rd(32'b0), .pcpi_wait(1'b0), .pcpi_ready(1'b0),
    .irq(32'b0));
  integer lane;
  always @(posedge clk) begin
    left <= load ? clocks : left - 1;
    done <= ~load & left == 1;
    if (begun != 7) begun <= begun + 1;
    ready <= resetn & valid & ~ready;
    if (resetn & valid & ~ready) begin
      word <= memory[address[9:2]];
      for (lane = 0; lane < 4; lane = lane + 1)
        if (lanes[lane]) memory[address[9:2]][8 * lane +: 8] <= data[8 * lane +: 8];
      if (lanes == 15) check <= {check[30:0], check[31]} ^ data;
    end
  end
endmodule
