// Two DDA integrators for an arc about the origin, counter-clockwise in the first quadrant, one step a clock. Each axis
// integrates the other one's coordinate: a pulse of x takes 1 from the integrand of y, a pulse of y adds 1 to that of x.
module dda_arc (
    input  wire        clk,
    input  wire        rst,
    input  wire [23:0] start_x,
    input  wire [23:0] start_y,
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
    wire pulse_x = run_x && carry_x;
    wire pulse_y = run_y && carry_y;
    assign done = !(run_x || run_y);

    always @(posedge clk) begin
        if (rst) begin
            integrand_x <= start_y;
            remainder_x <= 0;
            left_x      <= start_x - end_x;
            x           <= start_x;
        end else begin
            if (run_x) remainder_x <= next_x;
            if (pulse_x) begin
                x      <= x - 1;
                left_x <= left_x - 1;
            end
            if (pulse_y) integrand_x <= integrand_x + 1;
        end
    end

    always @(posedge clk) begin
        if (rst) begin
            integrand_y <= start_x;
            remainder_y <= 0;
            left_y      <= end_y - start_y;
            y           <= start_y;
        end else begin
            if (run_y) remainder_y <= next_y;
            if (pulse_y) begin
                y      <= y + 1;
                left_y <= left_y - 1;
            end
            if (pulse_x) integrand_y <= integrand_y - 1;
        end
    end
endmodule
