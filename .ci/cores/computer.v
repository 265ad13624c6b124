// A PicoRV32 with 1 KiB of memory, which holds its program, and the last word that it stored.
module computer (input clk, input resetn, output reg [31:0] stored, output trap);
  reg [31:0] memory [0:255];
  initial $readmemh("program.hex", memory);
  wire valid, instruction;
  wire [31:0] address, data;
  wire [3:0] lanes;
  reg ready = 0;
  reg [31:0] word = 0;
  picorv32 #(.ENABLE_MUL(1), .ENABLE_DIV(1)) core (
    .clk(clk), .resetn(resetn), .trap(trap), .mem_valid(valid), .mem_instr(instruction), .mem_ready(ready),
    .mem_addr(address), .mem_wdata(data), .mem_wstrb(lanes), .mem_rdata(word),
    .pcpi_wr(1'b0), .pcpi_rd(32'b0), .pcpi_wait(1'b0), .pcpi_ready(1'b0), .irq(32'b0));
  integer lane;
  always @(posedge clk) begin
    ready <= valid & ~ready;
    if (valid & ~ready) begin
      word <= memory[address[9:2]];
      for (lane = 0; lane < 4; lane = lane + 1)
        if (lanes[lane]) memory[address[9:2]][8 * lane +: 8] <= data[8 * lane +: 8];
      if (lanes == 15) stored <= data;
    end
  end
endmodule
