// Point-by-point comparison along an arc about the origin, counter-clockwise in the first quadrant. A step is four clocks:
// look at the sign of the deviation, put out the pulse, correct the deviation and the coordinate it came from, count.
module ppc_arc (
    input  wire        clk,
    input  wire        rst,
    input  wire [23:0] start_x,
    input  wire [23:0] start_y,
    input  wire [23:0] end_x,
    input  wire [23:0] end_y,
    output reg  [23:0] x,
    output reg  [23:0] y,
    output reg         done
);
    localparam JUDGE = 0, FEED = 1, CORRECT = 2, COUNT = 3;

    reg        [1:0]  beat;
    reg               inward;
    reg        [23:0] at_x, at_y;
    reg signed [25:0] deviation;
    reg        [24:0] steps;

    always @(posedge clk) begin
        if (rst) begin
            beat      <= JUDGE;
            done      <= 0;
            at_x      <= start_x;
            at_y      <= start_y;
            deviation <= 0;
            steps     <= (start_x - end_x) + (end_y - start_y);
            x         <= start_x;
            y         <= start_y;
        end else if (!done) begin
            beat <= beat + 1;
            case (beat)
                JUDGE: inward <= deviation >= 0;
                FEED:
                    if (inward) x <= x - 1;
                    else        y <= y + 1;
                CORRECT:
                    // (x - 1)^2 = x^2 - 2x + 1, (y + 1)^2 = y^2 + 2y + 1
                    if (inward) begin
                        deviation <= deviation - $signed({1'b0, at_x, 1'b0}) + 26'sd1;
                        at_x      <= at_x - 1;
                    end else begin
                        deviation <= deviation + $signed({1'b0, at_y, 1'b0}) + 26'sd1;
                        at_y      <= at_y + 1;
                    end
                COUNT: begin
                    steps <= steps - 1;
                    done  <= steps == 1;
                end
            endcase
        end
    end
endmodule
