#!/usr/bin/env python3
"""problems/demo: three cuts of a disc, as a spiral of round grooves that a stylus has read; and one of
them as a German instrument writes it, data/planflaeche.csv.

usage: demo.py ROOT_OF_THE_SOURCES
"""

import sys
from pathlib import Path

import numpy as np

from shop import Profile, Shop, carriage, polynomial_way, profile, three_cuts
from surface import Array, Pass

SEED = 20
DRIFT_UM, FADE_S = 1.5, 90.0
DIGITS = (3, 3)  # of mm and µm, as the instrument writes them

SHOP = Shop(radius=80.0, rpm=1000.0, feed=0.04, nose=0.8, points=797, diameter=True, sigma=0.03,
            tip=0.005, averages=True, traverse=0.5, wavelet="db1", level=2, lever="paper",
            overhang=0.0, degree=3, squareness=12e-6, bow=(1.6, -0.9))


def warming(tool: Pass) -> Array:
    """The spindle grows from the start of a cut."""
    return DRIFT_UM * (1 - np.exp(-tool.seconds / FADE_S))


def german(one: Profile) -> bytes:
    """Five header lines, semicolons, decimal commas, Latin-1."""
    head = ["Messprotokoll;Planfläche", "Maschine;LT-3", "Vorschub;40 mm/min;Drehzahl;1000 1/min",
            "Taster;5 µm", "Weg [mm];Höhe [µm]"]
    rows = [f"{x:.3f};{z:.3f}".replace(".", ",") for x, z in zip(one.x, one.z)]
    return "\r\n".join([*head, *rows, ""]).encode("latin-1")


def main(root: Path) -> None:
    folder = root / "problems/demo"
    rng = np.random.default_rng(SEED)
    motions = [carriage(SHOP, polynomial_way(SHOP)), warming]
    for name, cut in zip(["fine", "coarse", "outward"], three_cuts(SHOP)):
        one = profile(SHOP, rng, name, cut, motions)
        rows = "".join(f"{x:.{DIGITS[0]}f},{z:.{DIGITS[1]}f}\n" for x, z in zip(one.x, one.z))
        (folder / f"{name}.csv").write_text("x_mm,z_um\n" + rows)
        if name == "outward":
            (root / "data/planflaeche.csv").write_bytes(german(one))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
