"""The command line: one subcommand a stage, thin over `wnn2hdl.pipeline`."""

from wnn2hdl.cli import build, check, demo, doctor, evaluate, learn, locate, report, samples, scan, sweep  # noqa: F401  # importing a module registers its commands
from wnn2hdl.cli.main import main

__all__ = ["main"]
