"""A compiler from trained weightless neural networks to minimal FPGA logic."""

__version__ = "0.1.0"
