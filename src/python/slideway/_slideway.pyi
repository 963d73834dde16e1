import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__version__: str

class UsageError(ValueError): ...
class DataError(ValueError): ...

class Cancellation:
    def cancel(self) -> None: ...

def analyse(
    problem: str | dict[str, Any],
    profiles: dict[str, tuple[NDArray[np.float64], ...]],
    data: str | os.PathLike[str] | None,
    ranks_only: bool,
    closes_loop: bool,
    effects: list[
        tuple[
            str,
            Callable[..., Any],
            list[str],
            list[tuple[str, str, float | None, float | None]],
            str,
            str,
            str,
        ]
    ],
    progress: Callable[[str, float], object],
    cancellation: Cancellation,
) -> tuple[str, str]: ...
def page(json: str) -> str: ...
def picture(json: str) -> str: ...
def value_text(value: float, expanded_uncertainty: float) -> str: ...
def simulate(
    problem: str | dict[str, Any], seed: int | None, data: str | os.PathLike[str] | None
) -> list[tuple[str, str, str, NDArray[np.float64], NDArray[np.float64]]]: ...
def rank_columns(
    signal: NDArray[np.float64],
    candidates: dict[str, NDArray[np.float64]],
    wavelet: str,
    level: int,
    boundary: str,
) -> list[tuple[str, float, float, int, float, float, float]]: ...
def decompose(
    signal: NDArray[np.float64], wavelet: str, level: int, boundary: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
