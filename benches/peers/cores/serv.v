// A SERV with 8 KiB of memory, which holds its program: it runs for `clocks` clocks, and `check` gathers what it stores
// in the upper half of the addresses.
module core (input clk, input load, input [31:0] clocks, output reg done, output reg [31:0] check);
  reg [31:0] left = 0;
  reg [2:0] begun = 0;
  initial begin done = 0; check = 0; end
  wire [31:0] data;
  wire writes, strobe;
  reg ready = 0;
  serving #(.memfile("program.bytes"), .memsize(8192), .RESET_STRATEGY("MINI")) cpu (
    .i_clk(clk), .i_rst(begun != 7), .i_timer_irq(1'b0), .o_wb_dat(data), .o_wb_we(writes), .o_wb_stb(strobe),
    .i_wb_rdt(32'b0), .i_wb_ack(ready));
`ifdef __ICARUS__
  // Registers without reset, 0 at first in all other simulators.
  initial begin
    cpu.ram.o_wb_ack = 0;
    cpu.ram.bsel = 0;
  end
`endif
  always @(posedge clk) begin
    left <= load ? clocks : left - 1;
    done <= ~load & left == 1;
    if (begun != 7) begun <= begun + 1;
    ready <= begun == 7 & strobe & ~ready;
    if (begun == 7 & strobe & ~ready & writes) check <= {check[30:0], check[31]} ^ data;
  end
endmodule
