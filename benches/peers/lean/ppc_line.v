// Point-by-point comparison along a line from the origin, first quadrant. A step is four clocks: look at the sign of the
// deviation, put out the pulse, correct the deviation, count the step.
module ppc_line (
    input  wire        clk,
    input  wire        rst,
    input  wire [23:0] end_x,
    input  wire [23:0] end_y,
    output reg  [23:0] x,
    output reg  [23:0] y,
    output reg         done
);
    localparam JUDGE = 0, FEED = 1, CORRECT = 2, COUNT = 3;

    reg        [1:0]  beat;
    reg               along_x;
    reg        [23:0] line_x, line_y;
    reg signed [25:0] deviation;
    reg        [24:0] steps;

    always @(posedge clk) begin
        if (rst) begin
            beat      <= JUDGE;
            done      <= 0;
            line_x    <= end_x;
            line_y    <= end_y;
            deviation <= 0;
            steps     <= end_x + end_y;
            x         <= 0;
            y         <= 0;
        end else if (!done) begin
            beat <= beat + 1;
            case (beat)
                JUDGE: along_x <= deviation >= 0;
                FEED:
                    if (along_x) x <= x + 1;
                    else         y <= y + 1;
                CORRECT:
                    if (along_x) deviation <= deviation - $signed({2'b00, line_y});
                    else         deviation <= deviation + $signed({2'b00, line_x});
                COUNT: begin
                    steps <= steps - 1;
                    done  <= steps == 1;
                end
            endcase
        end
    end
endmodule
