// What holds of a video core whatever its streams do; Yosys reads it with -formal. One pixel per clock and
// lines of up to four; a pixel's class is its top bit, and the edge bit of a window that of its centre.
//
// Frames come in two phases: first anything, malformed frames among it, then whole frames of WIDTH by HEIGHT.
// Pixels of the first phase are of class 0, those of the second of class 1, so answers tell where they are from.
module video_properties (
    input aclk,
    input aresetn,
    input [1:0] width,
    input [1:0] height,
    input endless,
    input begins,
    input s_tvalid,
    input s_tuser,
    input s_tlast,
    input m_tready
);
    // Beats that the core may hold: those of a line, and what is in its registers.
    localparam HELD = 9;
    // Cycles without a beat in: those of a line that fills the memory, and what is in its registers.
    localparam PAUSE = 16;

    wire s_tready, m_tvalid, m_tuser, m_tlast;
    wire [7:0] m_tdata;
    reg good = 1'b0;
    wire phase = good || begins;

    formal_video core (
        .aclk(aclk),
        .aresetn(aresetn),
        .height(constant_endless ? 12'd0 : {10'd0, constant_height}),
        .s_axis_video_tdata({phase, 23'd0}),
        .s_axis_video_tvalid(s_tvalid),
        .s_axis_video_tready(s_tready),
        .s_axis_video_tuser(s_tuser),
        .s_axis_video_tlast(s_tlast),
        .m_axis_video_tdata(m_tdata),
        .m_axis_video_tvalid(m_tvalid),
        .m_axis_video_tready(m_tready),
        .m_axis_video_tuser(m_tuser),
        .m_axis_video_tlast(m_tlast)
    );

    // The size is chosen once.
    reg started = 1'b0;
    reg [1:0] chosen_width, chosen_height;
    reg chosen_endless;
    wire [1:0] constant_width = started ? chosen_width : width;
    wire [1:0] constant_height = started ? chosen_height : height;
    wire constant_endless = started ? chosen_endless : endless;

    // Where the next beat of the second phase is in its frame, on both sides.
    reg [1:0] in_column = 2'd0, in_line = 2'd0, out_column = 2'd0, out_line = 2'd0;
    reg [3:0] held = 4'd0;
    reg [4:0] pause = 5'd0;
    reg waiting = 1'b0, offered = 1'b0, answered = 1'b0;
    reg [9:0] before_out;
    reg [2:0] before_in;
    wire taken = s_tvalid && s_tready;
    wire given = m_tvalid && m_tready;
    wire from_good = m_tdata[0];

    always @(posedge aclk) begin
        started <= 1'b1;
        chosen_width <= constant_width;
        chosen_height <= constant_height;
        chosen_endless <= constant_endless;
        // A beat that is offered stays, and is of one phase.
        offered <= s_tvalid && !s_tready;
        before_in <= {phase, s_tuser, s_tlast};
        waiting <= m_tvalid && !m_tready;
        before_out <= {m_tdata, m_tuser, m_tlast};
        if (taken && phase) begin
            in_column <= s_tlast ? 2'd0 : in_column + 2'd1;
            if (s_tlast) in_line <= in_line + 2'd1 == constant_height ? 2'd0 : in_line + 2'd1;
        end
        if (given && from_good) begin
            out_column <= m_tlast ? 2'd0 : out_column + 2'd1;
            if (m_tlast) out_line <= out_line + 2'd1 == constant_height ? 2'd0 : out_line + 2'd1;
        end
        if (taken) good <= phase;
        answered <= answered || (given && from_good);
        held <= held + (taken && phase) - (given && from_good);
        pause <= taken || !s_tvalid || !m_tready ? 5'd0 : pause + 5'd1;
        if (!aresetn) begin
            {good, offered, waiting, answered} <= 4'd0;
            {in_column, in_line, out_column, out_line, held, pause} <= 17'd0;
        end
    end

    always @* begin
        assume (aresetn == started);
        assume (constant_width != 2'd0 && constant_height != 2'd0 && constant_height != 2'd3);
        if (offered) assume (s_tvalid && before_in == {phase, s_tuser, s_tlast});
        if (phase) begin
            assume (s_tuser == (in_column == 2'd0 && in_line == 2'd0));
            assume (s_tlast == (in_column + 2'd1 == constant_width));
        end
    end

    wire marked = m_tuser == (out_column == 2'd0 && out_line == 2'd0)
        && m_tlast == (out_column + 2'd1 == constant_width);
    wire stays = !waiting || (m_tvalid && before_out == {m_tdata, m_tuser, m_tlast});
    wire in_order = !m_tvalid || (from_good ? marked && m_tdata == 8'h81 && held != 4'd0
        : !answered && m_tdata == 8'h00);
    wire all_come = held <= constant_width + HELD;
    wire goes_on = pause < PAUSE;
    always @* assert (`PROPERTY);
endmodule
