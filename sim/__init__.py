"""Benches that run emitted Verilog in third-party simulators under cocotb; not installed with the package."""
