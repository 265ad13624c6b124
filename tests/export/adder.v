// an adder
// Registers have their reset values from the beginning, and again after an edge with rst = 1.

module adder(
    input wire clk,
    /* verilator tracing_off */
    input wire rst,
    input wire block_load
    /* verilator tracing_on */
);
    generate
        if (1) begin : block
            wire load = block_load;
        end
        if (1) begin : axis_x
            reg [3:0] jvx;
            reg [3:0] jrx;
            wire [4:0] _sum3 = {1'b0, jrx} + {1'b0, jvx};
            wire pulse = _sum3[4] & ~block.load;
            initial begin
                jvx = 4'd5;
                jrx = 4'd0;
            end
            always @(posedge clk)
                if (rst) begin
                    jvx <= 4'd5;
                    jrx <= 4'd0;
                end else begin
                    if (block.load) jrx <= 4'd8;
                    else jrx <= _sum3[3:0];
                end
        end
    endgenerate
endmodule
