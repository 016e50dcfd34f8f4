"""A testbench of a match engine that checks itself, in plain Verilog-2001."""

from collections.abc import Sequence

import numpy as np

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
from wnn2hdl.ir.engine import RESULT_WORDS, EngineFormat, Round, picture_words
from wnn2hdl.ir.registers import RESULT, RegisterMap

_SETTLES = 40
"""Cycles after the last word of a segment in which it gets complete: it goes in bit by bit."""


def engine_vectors(engine: EngineFormat, rounds: Sequence[Round]) -> str:
    """Segments, templates and results in the format of ``$readmemh``, a word of 32 bits each."""
    segments = [picture_words(match.segment) for match in rounds if match.segment is not None]
    templates = [picture_words(match.template) for match in rounds]
    results = [word for answer in engine.answers(rounds) for word in answer.words]
    return "".join(f"{word:08x}\n" for word in (*np.concatenate(segments + templates).tolist(), *results))


def engine_testbench(
    *,
    name: str,
    engine: EngineFormat,
    cycles: int,
    rounds: Sequence[Round],
    registers: RegisterMap,
    vectors_file: str,
    sources: Sequence[str],
) -> str:
    """A self-checking testbench ``NAME_tb`` for a match engine with registers ``NAME``.

    Both streams pause at random, the same way in each run. A segment, and a template up to its last
    pixel, come while the match before runs. It ends as the benches of `wnn2hdl.emit.testbench.testbench` do.

    Args:
        name: the module of the engine.
        engine: its sizes.
        cycles: of a match, from the last pixel of a template to the result.
        rounds: the matches, of which the file holds the `engine_vectors`.
        registers: the engine's.
        vectors_file: its name, without a folder.
        sources: names of the Verilog files of the engine, for the comment that says how to run it.
    """
    files = " ".join([*sources, f"{name}_tb.v"])
    count, words = len(rounds), engine.segment_words
    pixels = engine.template[0] * engine.template[1]
    template_words = -(-pixels // 32)
    fresh = "".join(str(int(match.segment is not None)) for match in reversed(rounds))
    segments = fresh.count("1")
    templates_at = segments * words
    results_at = templates_at + count * template_words
    ports = ",\n".join(
        f"        .{stream}_{signal}({short}_{signal})"
        for stream, short, signals in (
            ("s_axis_segment", "s", ("tdata", "tvalid", "tready", "tlast")),
            ("s_axis_template", "t", ("tdata", "tvalid", "tready", "tuser", "tlast")),
        )
        for signal in signals
    )
    ports += ",\n" + ",\n".join(bus_ports())
    before = [
        *identified(registers),
        write(registers, "interrupt_enable", 1),
        write(registers, "control", 1),
    ]
    # The values of results come from the file.
    result = [*(read(registers, name, 0) for name in RESULT), write(registers, "interrupt", 1)]
    after = [read(registers, "results", count), read(registers, "malformed", 0)]
    script = [*before, *result, *after]
    enabling = (
        "            // No template begins before it is enabled.\n"
        f"            if (access == {len(before) - 1} && pixel != 0) refuse;\n"
    )
    return f"""\
// Checks {name} in {count} matches; run it in this folder,
// with Icarus:    iverilog -o {name}_tb {files} && vvp -N {name}_tb
// with Verilator: verilator --binary --top-module {name}_tb {files} && obj_dir/V{name}_tb
module {name}_tb;
    reg [31:0] vectors [0:{results_at + RESULT_WORDS * count - 1}];
    reg [31:0] random = 32'h1;
    // In which matches a segment is sent first.
    reg [{count - 1}:0] fresh = {count}'b{fresh};
    reg aclk = 1'b0;
    reg aresetn = 1'b0;
    reg s_tvalid = 1'b0;
    reg t_tvalid = 1'b0;
    reg waits, taken, put, wrong;
    integer match, segment, word, pixel, received, settled, now, ended, i;
    reg [31:0] s_tdata, packed_pixels;
    reg [7:0] t_tdata;
    reg s_tlast, t_tuser, t_tlast;
    reg timed = 1'b0;
    wire s_tready, t_tready;
{bus_signals(len(script))}
    {name} dut (
        .aclk(aclk),
        .aresetn(aresetn),
{ports}
    );

{bus_tasks(name)}
    // A cycle.
    task step;
        begin
{PAUSES}            if (!s_tvalid && match < {count} && word < {words} && random[1:0] != 2'b00) begin
                s_tvalid = 1'b1;
                s_tdata = vectors[segment * {words} + word];
                s_tlast = word == {words - 1};
            end
            // The last pixel waits for the result before, and until the segment is complete.
            waits = pixel == {pixels - 1}
                && (received < match || word < {words} || settled <= {_SETTLES});
            if (!t_tvalid && match < {count} && pixel < {pixels} && !waits && random[5:4] != 2'b00) begin
                t_tvalid = 1'b1;
                packed_pixels = vectors[{templates_at} + match * {template_words} + pixel / 32];
                t_tdata = {{packed_pixels[pixel % 32], random[30:24]}};
                t_tuser = pixel == 0;
                t_tlast = pixel % {engine.template[1]} == {engine.template[1] - 1};
            end
            #1;
            taken = s_tvalid && s_tready;
            put = t_tvalid && t_tready;
            // The interrupt comes a cycle after the result.
            wrong = wrong || ^{{s_tready, t_tready, irq}} === 1'bx || (timed && now - ended > {cycles + 1});
            if (timed && irq) begin
                wrong = wrong || now - ended != {cycles + 1};
                timed = 1'b0;
            end
{SAMPLED}            #1 aclk = 1'b1;
            #1 aclk = 1'b0;
{CLOCKED}            if (taken) begin
                word = word + 1;
                s_tvalid = 1'b0;
            end
            if (put) begin
                pixel = pixel + 1;
                t_tvalid = 1'b0;
                timed = pixel == {pixels};
                ended = now;
            end
            settled = word < {words} ? 0 : settled + 1;
            if (match < {count} && pixel == {pixels} && word == {words}) begin
                match = match + 1;
                if (match < {count}) begin
                    pixel = 0;
                    if (fresh[match]) begin
                        word = 0;
                        segment = segment + 1;
                    end
                end
            end
            now = now + 1;
        end
    endtask

    initial begin
        $readmemh("{vectors_file}", vectors);
{filled(script)}        match = 0;
        segment = 0;
        word = 0;
        pixel = 0;
        received = 0;
        settled = 0;
        now = 0;
        ended = 0;
        wrong = 1'b0;
{RESET}{used(0, len(before), enabling)}        while (received < {count} && !wrong && !denied) begin
            step;
            if (irq) begin
                for (i = 0; i < {len(result)}; i = i + 1) begin
                    {{writes, answer, address, value}} = script[{len(before)} + i];
                    if (i < {RESULT_WORDS}) value = vectors[{results_at} + {RESULT_WORDS} * received + i];
                    use_register;
                end
                received = received + 1;
            end
        end
{used(len(before) + len(result), len(script))}        if (wrong) begin
            $display("FAIL: {name}, match %0d of {count}", received);
            $display("  %0d cycles, expected {cycles + 1}", now - ended);
        end
        if (wrong || denied) begin
            $stop;
            $finish;
        end
        $display("PASS: {name}, {count} matches of {cycles} cycles");
        $finish;
    end
endmodule
"""
