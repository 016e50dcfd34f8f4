// What holds of the registers of a core whatever its bus does within the rules of AXI4-Lite, and also where the
// two channels of a write come apart; Yosys reads it with -formal.
module bus_properties (
    input aclk,
    input aresetn,
    input [11:0] awaddr,
    input awvalid,
    input [31:0] wdata,
    input [3:0] wstrb,
    input wvalid,
    input bready,
    input [11:0] araddr,
    input arvalid,
    input rready,
    input frame,
    input malformed,
    input running,
    input [12:0] width,
    input [31:0] frames,
    input [15:0] faults
);
    // Cycles in which a request is taken, while answers are.
    localparam PAUSE = 4;
    localparam SLVERR = 2'd2;

    wire awready, wready, bvalid, arready, rvalid, irq;
    wire [1:0] bresp, rresp;
    wire [31:0] rdata;
    wire enable, resets, enable_frame, enable_malformed, frame_waits, malformed_waits;
    wire [11:0] height;

    formal_control core (
        .aclk(aclk),
        .aresetn(aresetn),
        .s_axi_control_awaddr(awaddr),
        .s_axi_control_awvalid(awvalid),
        .s_axi_control_awready(awready),
        .s_axi_control_wdata(wdata),
        .s_axi_control_wstrb(wstrb),
        .s_axi_control_wvalid(wvalid),
        .s_axi_control_wready(wready),
        .s_axi_control_bresp(bresp),
        .s_axi_control_bvalid(bvalid),
        .s_axi_control_bready(bready),
        .s_axi_control_araddr(araddr),
        .s_axi_control_arvalid(arvalid),
        .s_axi_control_arready(arready),
        .s_axi_control_rdata(rdata),
        .s_axi_control_rresp(rresp),
        .s_axi_control_rvalid(rvalid),
        .s_axi_control_rready(rready),
        .irq(irq),
        .interrupt_frame(frame),
        .interrupt_malformed(malformed),
        .status_running(running),
        .width(width),
        .frames(frames),
        .malformed(faults),
        .control_enable(enable),
        .control_reset(resets),
        .interrupt_enable_frame(enable_frame),
        .interrupt_enable_malformed(enable_malformed),
        .interrupt_frame_waits(frame_waits),
        .interrupt_malformed_waits(malformed_waits),
        .height(height)
    );

    reg started = 1'b0;
    reg aw_waits = 1'b0, w_waits = 1'b0, ar_waits = 1'b0, b_waits = 1'b0, r_waits = 1'b0;
    reg [11:0] aw_before, ar_before;
    reg [35:0] w_before;
    reg [1:0] b_before;
    reg [33:0] r_before;
    // Requests that were taken and not answered.
    reg aw_open = 1'b0, w_open = 1'b0, ar_open = 1'b0;
    reg [11:0] aw_taken, ar_taken;
    reg [31:0] word;
    reg [2:0] w_pause = 3'd0, r_pause = 3'd0;
    // What the height has to be, byte by byte, and events that were not cleared.
    reg [11:0] wanted = 12'd0;
    reg event_left = 1'b0;

    wire writes = awvalid && awready;
    wire [11:0] written = {wstrb[1] ? wdata[11:8] : wanted[11:8], wstrb[0] ? wdata[7:0] : wanted[7:0]};
    wire writable = aw_taken[11:2] == 10'd2 || aw_taken[11:2] == 10'd3 || aw_taken[11:2] == 10'd4
        || aw_taken[11:2] == 10'd6;
    wire readable = ar_taken[11:2] < 10'd10;

    always @(posedge aclk) begin
        started <= 1'b1;
        aw_waits <= awvalid && !awready;
        w_waits <= wvalid && !wready;
        ar_waits <= arvalid && !arready;
        b_waits <= bvalid && !bready;
        r_waits <= rvalid && !rready;
        aw_before <= awaddr;
        w_before <= {wdata, wstrb};
        ar_before <= araddr;
        b_before <= bresp;
        r_before <= {rdata, rresp};
        if (writes) aw_taken <= awaddr;
        if (arvalid && arready) ar_taken <= araddr;
        aw_open <= writes || (aw_open && !(bvalid && bready));
        w_open <= (wvalid && wready) || (w_open && !(bvalid && bready));
        ar_open <= (arvalid && arready) || (ar_open && !(rvalid && rready));
        w_pause <= awvalid && wvalid && !awready && (!bvalid || bready) ? w_pause + 3'd1 : 3'd0;
        r_pause <= arvalid && !arready && (!rvalid || rready) ? r_pause + 3'd1 : 3'd0;
        if (writes && awaddr[11:2] == 10'd6) wanted <= written;
        event_left <= frame || (event_left && !(writes && awaddr[11:2] == 10'd4 && wstrb[0] && wdata[0]));
        // What a register holds when it is read.
        word <= araddr[11:2] == 10'd6 ? {20'd0, wanted} : araddr[11:2] == 10'd4 ? {31'd0, event_left} : 32'd0;
        if (!aresetn) begin
            {aw_waits, w_waits, ar_waits, b_waits, r_waits} <= 5'd0;
            {aw_open, w_open, ar_open, event_left} <= 4'd0;
            {w_pause, r_pause} <= 6'd0;
            wanted <= 12'd0;
        end
    end

    always @* begin
        assume (aresetn == started);
        if (aw_waits) assume (awvalid && awaddr == aw_before);
        if (w_waits) assume (wvalid && {wdata, wstrb} == w_before);
        if (ar_waits) assume (arvalid && araddr == ar_before);
    end

    wire stays = (!b_waits || (bvalid && bresp == b_before)) && (!r_waits || (rvalid && {rdata, rresp} == r_before));
    wire answers = bvalid == (aw_open && w_open) && aw_open == w_open && rvalid == ar_open
        && (!aw_open || !(awready || wready) || bready) && (!ar_open || !arready || rready);
    wire refuses = (!bvalid || bresp == (writable ? 2'd0 : SLVERR)) && (!rvalid || rresp == (readable ? 2'd0 : SLVERR));
    wire goes_on = w_pause < PAUSE && r_pause < PAUSE;
    wire keeps = height == wanted && frame_waits == event_left
        && irq == ((frame_waits && enable_frame) || (malformed_waits && enable_malformed))
        && (!rvalid || r_waits || ar_taken[11:2] != 10'd6 || rdata == word)
        && (!rvalid || r_waits || ar_taken[11:2] != 10'd4 || rdata[0] == word[0]);
    always @* assert (`PROPERTY);
endmodule
