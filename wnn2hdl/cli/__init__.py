"""The command line: one subcommand a stage, thin over `wnn2hdl.pipeline`."""

from wnn2hdl.cli import (  # noqa: F401  # importing a module registers its commands
    build,
    check,
    demo,
    doctor,
    evaluate,
    import_,
    learn,
    locate,
    report,
    samples,
    scan,
    sweep,
)
from wnn2hdl.cli.main import main

__all__ = ["main"]
