"""The command line: one subcommand per stage, thin over the stages; each is imported when it is asked for."""

from wnn2hdl.cli.main import main

__all__ = ["main"]
