"""Values of a JSON document as the types that stand in a dataclass."""

from __future__ import annotations

import dataclasses
import functools
import math
import types
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np


@functools.cache
def _fields(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def made(kind: Any, value: Any) -> Any:
    """The value of a JSON document as a type: dataclass, list, tuple, array, or as it is."""
    origin = get_origin(kind)
    if origin in (types.UnionType, Union):
        return None if value is None else made(get_args(kind)[0], value)
    if kind is float:
        return math.nan if value is None else float(value)
    if origin is list:
        return [made(get_args(kind)[0], each) for each in value]
    if origin is tuple:
        return tuple(made(each, part) for each, part in zip(get_args(kind), value, strict=True))
    if origin is np.ndarray:
        return np.asarray(value, get_args(get_args(kind)[1])[0])
    if dataclasses.is_dataclass(kind):
        hints = _fields(kind)
        return kind(**{key: made(hints[key], each) for key, each in value.items() if key in hints})
    return value
