// Two DDA integrators for a line from the origin, first quadrant, one step a clock. The integrands are the coordinates of
// the end point and stay as they are; each axis stops for itself once it has put out all of its pulses.
module dda_line (
    input  wire        clk,
    input  wire        rst,
    input  wire [23:0] end_x,
    input  wire [23:0] end_y,
    output reg  [23:0] x,
    output reg  [23:0] y,
    output wire        done
);
    reg [23:0] integrand_x, remainder_x, left_x;
    reg [23:0] integrand_y, remainder_y, left_y;

    wire run_x = |left_x;
    wire run_y = |left_y;
    wire carry_x, carry_y;
    wire [23:0] next_x, next_y;

    assign {carry_x, next_x} = remainder_x + integrand_x;
    assign {carry_y, next_y} = remainder_y + integrand_y;
    assign done = !(run_x || run_y);

    always @(posedge clk) begin
        if (rst) begin
            integrand_x <= end_x;
            remainder_x <= 0;
            left_x      <= end_x;
            x           <= 0;
        end else if (run_x) begin
            remainder_x <= next_x;
            if (carry_x) begin
                x      <= x + 1;
                left_x <= left_x - 1;
            end
        end
    end

    always @(posedge clk) begin
        if (rst) begin
            integrand_y <= end_y;
            remainder_y <= 0;
            left_y      <= end_y;
            y           <= 0;
        end else if (run_y) begin
            remainder_y <= next_y;
            if (carry_y) begin
                y      <= y + 1;
                left_y <= left_y - 1;
            end
        end
    end
endmodule
