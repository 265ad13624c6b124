// A VexRiscv with 1 KiB of memory for both of its buses: it runs for `clocks` clocks, and `check` gathers what it stores.
module core (input clk, input load, input [31:0] clocks, output reg done, output reg [31:0] check);
  reg [31:0] left = 0;
  reg [2:0] begun = 0;
  reg [31:0] memory [0:255];
  initial $readmemh("program.hex", memory);
  initial begin done = 0; check = 0; end
  wire fetches, accesses, writes;
  wire [29:0] fetched, accessed;
  wire [31:0] data;
  wire [3:0] lanes;
  reg fetch_ready = 0, access_ready = 0;
  reg [31:0] fetch_word = 0, access_word = 0;
  VexRiscv cpu (
    .clk(clk), .reset(begun != 7), .externalResetVector(32'b0), .timerInterrupt(1'b0), .softwareInterrupt(1'b0),
    .externalInterruptArray(32'b0),
    .iBusWishbone_STB(fetches), .iBusWishbone_ACK(fetch_ready), .iBusWishbone_ADR(fetched),
    .iBusWishbone_DAT_MISO(fetch_word), .iBusWishbone_ERR(1'b0),
    .dBusWishbone_STB(accesses), .dBusWishbone_ACK(access_ready), .dBusWishbone_WE(writes),
    .dBusWishbone_ADR(accessed), .dBusWishbone_DAT_MISO(access_word), .dBusWishbone_DAT_MOSI(data),
    .dBusWishbone_SEL(lanes), .dBusWishbone_ERR(1'b0));
  integer lane;
  always @(posedge clk) begin
    left <= load ? clocks : left - 1;
    done <= ~load & left == 1;
    if (begun != 7) begun <= begun + 1;
    fetch_ready <= begun == 7 & fetches & ~fetch_ready;
    fetch_word <= memory[fetched[7:0]];
    access_ready <= begun == 7 & accesses & ~access_ready;
    access_word <= memory[accessed[7:0]];
    if (begun == 7 & accesses & ~access_ready & writes) begin
      for (lane = 0; lane < 4; lane = lane + 1)
        if (lanes[lane]) memory[accessed[7:0]][8 * lane +: 8] <= data[8 * lane +: 8];
      check <= {check[30:0], check[31]} ^ data;
    end
  end
endmodule
