"""Component to files: Verilog, testbench with vectors, manifest."""

from wnn2hdl.emit.manifest import MANIFEST_NAME, check, manifest, write_manifest
from wnn2hdl.emit.testbench import testbench, vectors
from wnn2hdl.emit.verilog import vendor_cells_model, verilog

__all__ = [
    "MANIFEST_NAME",
    "check",
    "manifest",
    "testbench",
    "vectors",
    "vendor_cells_model",
    "verilog",
    "write_manifest",
]
