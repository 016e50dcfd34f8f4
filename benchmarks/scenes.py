"""The arguments of benchmarks that run on a folder of pictures and one of masks."""

from argparse import ArgumentParser
from pathlib import Path


def scene_parser(description: str | None) -> ArgumentParser:
    """A parser of ``IMAGES MASKS [--seed 0]``, described by the first line of a module's docstring."""
    parser = ArgumentParser(description=description.splitlines()[0] if description else None)
    parser.add_argument("images", type=Path)
    parser.add_argument("masks", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    return parser
