"""nextpnr and the writers of bitstreams, started."""

from pathlib import Path

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.placers import Program


def test_a_missing_package_names_the_extra() -> None:
    program = Program("nextpnr-none", "yowasp-nextpnr-none", "")
    with pytest.raises(
        ToolError, match=r"yowasp-nextpnr-none is not installed; pip install 'wnn2hdl\[place\]'"
    ):
        program.version()


def test_a_failure_is_told_by_its_line_and_the_name_of_the_program(tmp_path: Path) -> None:
    program = Program("nextpnr", "pyosys", "print('ERROR: no room'); print('more')")
    with pytest.raises(ToolError, match=r"^nextpnr failed with exit status 0: ERROR: no room"):
        program.run([], cwd=tmp_path)
