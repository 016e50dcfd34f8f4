"""``python -m wnn2hdl`` is the `wnn2hdl` command."""

import sys

from wnn2hdl.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
