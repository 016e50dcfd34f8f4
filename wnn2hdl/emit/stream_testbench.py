"""A testbench of a video core that checks itself against the model's answers, in plain Verilog-2001."""

from collections.abc import Sequence
from itertools import chain

from wnn2hdl.emit.register_bench import (
    CLOCKED,
    PAUSES,
    RESET,
    SAMPLED,
    bus_ports,
    bus_signals,
    bus_tasks,
    filled,
    identified,
    read,
    used,
    write,
)
from wnn2hdl.ir.registers import RegisterMap
from wnn2hdl.ir.video import ANSWER_BITS, HEIGHT_BITS, Beats, VideoFormat

_PATIENCE = 1 << 14
"""Cycles without a beat that show a core that is stuck: longer than two lines take."""


def stream_vectors(beats: Beats, video: VideoFormat) -> str:
    """Beats in the format of ``$readmemh``, a line each.

    In the order of the bits from the highest: TUSER and TLAST, which are the same on both sides, the answers,
    the pixels; of both those on the right first. Behind them the beats of squares, whose majority is an
    answer.
    """
    marks = (beats.starts.astype(int) << 1 | beats.ends).tolist()
    answer, pixel = (bits * video.pixels_per_clock // 4 for bits in (ANSWER_BITS, video.pixel_bits))
    words = zip(marks, beats.expected(), beats.sent(video.pixel_bits), strict=True)
    squares = ((start << 1 | last, majority, 0) for majority, start, last in beats.voted())
    return "".join(
        f"{mark:x}{answers:0{answer}x}{pixels:0{pixel}x}\n" for mark, answers, pixels in chain(words, squares)
    )


_SIGNALS = ("tdata", "tvalid", "tready", "tuser", "tlast")

_SQUARES_DECLARED = """\
    reg q_tready = 1'b0;
    integer voted = 0;
    wire [7:0] q_tdata;
    wire q_tvalid, q_tuser, q_tlast;
"""

_SQUARES_DRAWN = """\
            q_tready = random[17:16] != 2'b00;
"""

_SQUARES_CHECKED = """\
            if (q_tvalid && q_tready) begin
                expected = vectors[{count} + voted];
                if (voted >= {votes} || {{q_tuser, q_tlast}} !== expected[{marks}:{marks} - 1]
                    || q_tdata !== expected[{low} + 7:{low}]) begin
                    $display("FAIL: {name}, square %0d of {votes}", voted);
                    $display("  tuser, tlast, tdata = %h", {{q_tuser, q_tlast, q_tdata}});
                    $stop;
                    $finish;
                end
                voted = voted + 1;
            end
"""


def stream_testbench(
    *,
    name: str,
    video: VideoFormat,
    beats: Beats,
    registers: RegisterMap,
    vectors_file: str,
    sources: Sequence[str],
) -> str:
    """A self-checking testbench ``NAME_tb`` for a video core with registers ``NAME``.

    Both sides pause at random, the same way in each run; registers are read meanwhile. It ends as the benches
    of `wnn2hdl.emit.testbench.testbench` do.

    Args:
        name: the module of the core.
        video: its streams.
        beats: what goes through.
        registers: the core's.
        vectors_file: name of the file with the `stream_vectors` of the beats, without a folder.
        sources: names of the Verilog files of the core, for the comment that says how to run it.
    """
    files = " ".join([*sources, f"{name}_tb.v"])
    count, votes = len(beats), len(beats.voted())
    whole = sum(lines == beats.height for lines in beats.lines)
    # The last frame ends without another one, if it is whole.
    cut = sum(lines != beats.height for lines in beats.lines[:-1])
    before = [
        *identified(registers),
        write(registers, "height", beats.height % (1 << HEIGHT_BITS)),
        write(registers, "interrupt_enable", 1),
        write(registers, "control", 1),
    ]
    after = [
        read(registers, "frames", whole),
        read(registers, "malformed", cut),
        read(registers, "width", beats.width),
        read(registers, "status", 0),
        write(registers, "interrupt", 1),
    ]
    script = [*before, *after]
    pixels, answers = (bits * video.pixels_per_clock for bits in (video.pixel_bits, ANSWER_BITS))
    word = pixels + answers + 2
    bus = ",\n".join(bus_ports())
    streams = ",\n".join(
        f"        .{side}_axis_video_{signal}({side}_{signal})" for side in "sm" for signal in _SIGNALS
    )
    enabling = (
        "            // No frame begins before it is enabled.\n"
        f"            if (access == {len(before) - 1} && sent != 0) refuse;\n"
    )
    interrupted = "            if (irq !== 1'b1) refuse;\n"
    declared, drawn, checked, waits = "", "", "", f"received < {count}"
    if video.square is not None:
        streams += "".join(f",\n        .m_axis_squares_{signal}(q_{signal})" for signal in _SIGNALS)
        declared, drawn = _SQUARES_DECLARED, _SQUARES_DRAWN
        waits += f" || voted < {votes}"
        checked = _SQUARES_CHECKED.format(name=name, count=count, votes=votes, marks=word - 1, low=pixels)
    return f"""\
// Checks {name} against {count} answers of the model; run it in this folder,
// with Icarus:    iverilog -o {name}_tb {files} && vvp -N {name}_tb
// with Verilator: verilator --binary --top-module {name}_tb {files} && obj_dir/V{name}_tb
module {name}_tb;
    reg [{word - 1}:0] vectors [0:{count + votes - 1}];
    reg [{word - 1}:0] sending;
    reg [{word - 1}:0] expected;
    reg [31:0] random = 32'h1;
    reg aclk = 1'b0;
    reg aresetn = 1'b0;
    reg s_tvalid = 1'b0;
    reg m_tready = 1'b0;
    reg taken, given;
    integer sent, received, idle;
    wire [{pixels - 1}:0] s_tdata = sending[{pixels - 1}:0];
    wire s_tuser = sending[{word - 1}];
    wire s_tlast = sending[{word - 2}];
    wire s_tready;
    wire [{answers - 1}:0] m_tdata;
    wire m_tvalid, m_tuser, m_tlast;
{declared}{bus_signals(len(script))}
    {name} dut (
        .aclk(aclk),
        .aresetn(aresetn),
{bus},
{streams}
    );

{bus_tasks(name)}
    // A cycle.
    task step;
        begin
{PAUSES}            s_tvalid = s_tvalid || (sent < {count} && random[1:0] != 2'b00);
            m_tready = random[9:8] != 2'b00;
{drawn}            sending = s_tvalid ? vectors[sent] : {{{word}{{1'bx}}}};
            expected = vectors[received];
            #1;
            taken = s_tvalid && s_tready;
            given = m_tvalid && m_tready;
            // A beat with unknown bits was not read: the file is missing or too short.
            if ((given && (received >= {count} || ^expected === 1'bx
                || {{m_tuser, m_tlast, m_tdata}} !== expected[{word - 1}:{pixels}]))
                || (^{{s_tready, m_tvalid}} === 1'bx)) begin
                $display("FAIL: {name}, beat %0d of {count}", received);
                $display("  tuser, tlast, tdata = %h, expected %h",
                    {{m_tuser, m_tlast, m_tdata}}, expected[{word - 1}:{pixels}]);
                $stop;
                $finish;
            end
{checked}{SAMPLED}            #1 aclk = 1'b1;
            #1 aclk = 1'b0;
{CLOCKED}            if (taken) begin
                sent = sent + 1;
                s_tvalid = 1'b0;
            end
            if (given) received = received + 1;
            idle = taken || given ? 0 : idle + 1;
        end
    endtask

    initial begin
        $readmemh("{vectors_file}", vectors);
{filled(script)}        sent = 0;
        received = 0;
        idle = 0;
{RESET}{used(0, len(before), enabling)}        while (({waits}) && idle < {_PATIENCE} && !denied) begin
            step;
            // The version, now and then.
            {{writes, answer, address, value}} = script[0];
            if (random[15:10] == 6'd0) use_register;
        end
        if (({waits}) && !denied) begin
            $display("FAIL: {name} stopped after %0d of {count} beats", received);
            $stop;
            $finish;
        end
        repeat (4) step;
{used(len(before), len(script), interrupted)}        if (irq !== 1'b0) refuse;
        if (denied) begin
            $stop;
            $finish;
        end
        $display("PASS: {name}, {count} beats");
        $finish;
    end
endmodule
"""
