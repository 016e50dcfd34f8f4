"""`verify`, `simulate` and `synth`: check, run or count an existing build."""

from dataclasses import asdict
from pathlib import Path
from typing import get_args

import click
import numpy as np

from wnn2hdl.build.checking import synthesise_parts
from wnn2hdl.build.compile import require_proved
from wnn2hdl.build.folder import REPORT_PAGE
from wnn2hdl.build.implementing import implement, write_vivado
from wnn2hdl.build.placing import PlacedBuild, place_build
from wnn2hdl.build.playback import SimulatorName, play
from wnn2hdl.build.verification import open_build, verify_build
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import allow_unproved_option, file, folder, output_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import reading_options
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.files import make_folder
from wnn2hdl.images import write_png
from wnn2hdl.raster import Reading
from wnn2hdl.report import HARNESSES
from wnn2hdl.synth import FABRICS, XC7Z020

build_argument = click.argument("build", type=folder)


@app.command("verify")
@build_argument
@allow_unproved_option
@json_option
def verify_command(build: Path, allow_unproved: tuple[str, ...], as_json: bool) -> None:
    """Check BUILD from its files alone: hashes, simulation, proof, LUT counts.

    \b
    Examples:
      wnn2hdl verify build/mine
      wnn2hdl verify build/mine --json | jq .problems
    """
    with progress() as report:
        problems, checked = verify_build(build, report)
    data = {
        "build": str(build),
        "verified": not problems,
        "problems": problems,
        "proof": None
        if checked is None
        else {
            "status": checked.status,
            "method": checked.method,
            "seconds": checked.proof_seconds,
            "claims": list(map(asdict, checked.claims)),
            "unproved": list(checked.unproved),
        },
        "vectors": {} if checked is None else dict(checked.vectors),
    }
    unproved = () if checked is None else checked.unproved
    proved = f"UNPROVED ({', '.join(unproved)})" if unproved else "proved"
    text = f"{build}: files unchanged, simulated, {proved}, counted" if not problems else "\n".join(problems)
    emit(data, text, as_json=as_json)
    if problems:
        raise CheckError(f"{build} does not pass its checks", value=problems[0])
    require_proved(unproved, allow_unproved)


@app.command("simulate")
@build_argument
@click.option("--image", type=file, required=True, help="Run over this picture.")
@reading_options
@click.option(
    "--simulator",
    type=click.Choice(get_args(SimulatorName)),
    default="amaranth",
    show_default=True,
    help="Simulate the circuit with this program.",
)
@click.option(
    "--vcd",
    type=file,
    help="Record the waves here (with Amaranth's simulator).",
)
@output_option("Write the pictures into this folder.  [default: BUILD/simulation]")
@json_option
def simulate_command(
    build: Path,
    image: Path,
    reading: Reading,
    simulator: SimulatorName,
    vcd: Path | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Run the circuit of BUILD over every window of a picture and compare each output bit.

    A video core gets the picture as a frame, with pauses on both sides; what it sends is written too.

    \b
    Examples:
      wnn2hdl simulate build/mine --image photo.png --simulator verilator -o build/pictures
      wnn2hdl simulate build/mine --image photo.png --vcd build/waves.vcd
    """
    with progress() as report:
        result = play(build, image, simulator, report, vcd, reading)
    output = output or build / "simulation"
    make_folder(output)
    found = {
        "class": result.foreground,
        "edge": result.edges,
        "frame": result.frame,
        "squares": result.squares,
    }
    pictures = {name: array for name, array in found.items() if array is not None}
    for name, array in pictures.items():
        write_png(output / f"{image.stem}-{name}.png", array)
    places = "windows" if pictures.keys() == {"class"} else "pixels"
    runs = "windows" if result.frame is None else "pixels"
    rate = result.windows / result.seconds
    known = f"; {result.cared:.2%} of the {places} have a code that the circuit is proved on"
    data = {
        "image": str(image),
        "simulator": simulator,
        "windows": result.windows,
        "seconds": result.seconds,
        "windows_per_second": rate,
        "compile_seconds": result.compile_seconds,
        "cared": result.cared,
        "foreground": float(np.mean(result.foreground)),
        "pictures": [str(output / f"{image.stem}-{name}.png") for name in pictures],
    }
    text = (
        f"{image}: {result.windows:,} {runs} in {result.seconds:.1f} s ({rate:,.0f} per second), all bits "
        f"as the model says{known if result.cared < 1 else ''}\npictures in {output}"
    )
    emit(data, text, as_json=as_json)


@app.command("synth")
@build_argument
@click.option(
    "--device",
    type=click.Choice([XC7Z020.name, *FABRICS]),
    default=XC7Z020.name,
    show_default=True,
    help="Count for this device; place and route on one that has other LUTs.",
)
@click.option(
    "--tool",
    type=click.Choice(["yosys", "vivado"]),
    default="yosys",
    show_default=True,
    help="Count with this program; Vivado also places and routes, out of context.",
)
@click.option("--scripts", is_flag=True, help="Write what Vivado runs, and do not run it.")
@click.option(
    "--pins",
    type=file,
    help="Assign ports to pins by these constraints (.lpf, .pcf or .cst).  [default: assigned automatically]",
)
@output_option("Write bitstream or scripts into this folder.  [default: BUILD-DEVICE, BUILD-vivado]")
@json_option
def synth_command(
    build: Path,
    device: str,
    tool: str,
    scripts: bool,
    pins: Path | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Count the LUTs of BUILD again, or place and route it and write a bitstream.

    Place and route needs the extra `place`. Its figures are added to the report of BUILD. The ports of a
    combinational circuit get registers on both sides, and shift registers where there are fewer pins.

    \b
    Examples:
      wnn2hdl synth build/mine --json | jq .parts.block.luts
      wnn2hdl synth build/mine --device ecp5-25k -o build/bitstream
    """
    if tool == "vivado":
        if device in FABRICS or pins is not None:
            raise InputError(f"Vivado is for {XC7Z020.name}, out of context and without pins")
        _in_vivado(build, output or _beside(build, tool), scripts, as_json)
        return
    if scripts:
        raise InputError("only Vivado has scripts", hint="give --tool vivado")
    if device in FABRICS:
        output = output or _beside(build, device)
        with progress() as report:
            done = place_build(build, device, output, pins, report)
        data = {"build": str(build), "placed": {device: done.figures}, "files": list(map(str, done.files))}
        emit(data, _placed(build, device, done), as_json=as_json)
        return
    if pins is not None or output is not None:
        raise InputError(
            f"a count for {device} takes no pins and writes no files",
            hint=f"give --device {' or '.join(FABRICS)}",
        )
    design, files, _ = open_build(build)
    with progress() as report:
        syntheses = synthesise_parts(design, files, report)
    parts = {part: asdict(result.resources) for part, result in syntheses.items()}
    first = next(iter(syntheses.values()))
    data = {
        "build": str(build),
        "parts": parts,
        "tool": first.tool,
        "version": first.version,
        "options": first.options,
    }
    lines = [f"{part}: {figures['luts']} LUTs, {figures['delay_ps']} ps" for part, figures in parts.items()]
    emit(data, "\n".join([f"{first.tool} {first.version}, {first.options}", *lines]), as_json=as_json)


def _beside(build: Path, what: str) -> Path:
    return build.resolve().with_name(f"{build.resolve().name}-{what}")


def _in_vivado(build: Path, output: Path, scripts: bool, as_json: bool) -> None:
    if scripts:
        written = write_vivado(build, output)
        run = [f"vivado -mode batch -source {file}" for file in written if file.suffix == ".tcl"]
        emit({"build": str(build), "files": list(map(str, written))}, "\n".join(run), as_json=as_json)
        return
    with progress() as report:
        figures = implement(build, output, report)
    text = (
        f"{figures['luts']} LUTs, {figures['ffs']} flip-flops, {figures['bram36']:g} block RAMs, "
        f"{figures['dsp']} DSP slices; {figures['fmax_mhz']:.1f} MHz after routing, by Vivado "
        f"{figures['version']}\nfigures added to {build / REPORT_PAGE}"
    )
    emit({"build": str(build), "vivado": figures}, text, as_json=as_json)


def _placed(build: Path, device: str, done: PlacedBuild) -> str:
    figures = done.figures
    cells = figures["cells"]
    fmax = "no clock" if figures["fmax_mhz"] is None else f"{figures['fmax_mhz']:.1f} MHz"
    rams = "1 block RAM" if cells["rams"] == 1 else f"{cells['rams']} block RAMs"
    return (
        f"{figures['circuit']} on {device}: {cells['luts']} LUTs of four inputs, {cells['ffs']} flip-flops, "
        f"{rams}; {fmax} after routing; netlist before placement: {figures['proof']}\n"
        f"{HARNESSES[figures['harness']]}; pins {figures['pins']}, seed {figures['seed']}\n"
        f"bitstream {done.files[-1]}; figures added to {build / REPORT_PAGE}"
    )
