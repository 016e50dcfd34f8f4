"""Where a drone was, from the edges in its frames and a map.

Run it as ``python examples/position_from_edges.py [FOLDER]``; tables and plots go there. A flight of your own
is given as ``locate(recording("map.tif", "FRAMES", "poses.csv", 750.0), calibrate=10)``.
"""

import sys
from pathlib import Path

from wnn2hdl.api import locate


def main(folder: Path) -> None:
    """Locate a generated flight, half of whose frames calibrate."""
    flight = locate(calibrate=5, methods=["perspective-weightless"])
    print(flight)
    for fix in flight.methods["map"]["perspective-weightless"].fixes:
        print(f"{fix.frame}: {fix.latitude:.6f}, {fix.longitude:.6f}, {fix.error_m:.1f} m off")
    flight.write(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("build/example"))
