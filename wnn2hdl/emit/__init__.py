"""Component to files: Verilog, models of cells, testbench with vectors, manifest."""

from wnn2hdl.emit.cells import CELLS_FILE, cells_model
from wnn2hdl.emit.engine_testbench import engine_testbench, engine_vectors
from wnn2hdl.emit.manifest import MANIFEST_NAME, check, manifest, renew_manifest, write_manifest
from wnn2hdl.emit.registers import c_header, driver_class, python_driver, registers_table
from wnn2hdl.emit.stream_testbench import stream_testbench, stream_vectors
from wnn2hdl.emit.testbench import testbench, vectors
from wnn2hdl.emit.verilog import verilog

__all__ = [
    "CELLS_FILE",
    "MANIFEST_NAME",
    "c_header",
    "cells_model",
    "check",
    "driver_class",
    "engine_testbench",
    "engine_vectors",
    "manifest",
    "python_driver",
    "registers_table",
    "renew_manifest",
    "stream_testbench",
    "stream_vectors",
    "testbench",
    "vectors",
    "verilog",
    "write_manifest",
]
