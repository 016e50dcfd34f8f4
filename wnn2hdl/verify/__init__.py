"""Proof and simulation of what was emitted."""
