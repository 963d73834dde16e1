"""From what callers write to what the compiled half takes."""

from __future__ import annotations

import numbers
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from slideway._slideway import UsageError
from slideway._typed import Problem

AnyProblem = str | os.PathLike[str] | Mapping[str, Any] | Problem


def plain(value: Any, where: str = "problem") -> Any:
    """The value in dict, list, str, bool, int and float alone, as TOML has them."""
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, numbers.Integral):
        if not -(2**63) <= int(value) < 2**63:
            raise UsageError(f"{where}: {value} is out of range; accepted: 64 bits")
        return int(value)
    if isinstance(value, numbers.Real):
        return float(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise UsageError(f"{where}: key {key!r} is no str")
        return {key: plain(each, f"{where}.{key}") for key, each in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), where)
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [plain(each, f"{where}[{i}]") for i, each in enumerate(value)]
    raise UsageError(
        f"{where}: {type(value).__name__} is nothing a problem holds; "
        "accepted: dict, list, str, bool, int, float; a key without a value is left out"
    )


def source(problem: AnyProblem) -> Any:
    """A path, or a plain dict."""
    if isinstance(problem, Problem):
        return plain(problem.to_dict())
    if isinstance(problem, Mapping):
        return plain(problem)
    if isinstance(problem, (str, os.PathLike)):
        return os.fspath(problem)
    raise UsageError(f"problem: {type(problem).__name__}; accepted: path of a problem file, dict, or Problem")
