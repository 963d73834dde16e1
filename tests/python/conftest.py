"""What the tests share: the shipped problems, and the program to hold the module against."""

import json
import os
import pathlib
import subprocess
import tomllib

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def problem_file(name):
    return ROOT / "problems" / name


def problem_dict(name):
    """A shipped problem as a dict without files, and its profiles as arrays."""
    path = problem_file(name)
    problem = tomllib.loads(path.read_text(encoding="utf-8"))
    profiles = {}
    for profile in problem["profile"]:
        file = path.parent / profile.pop("file")
        lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
        columns = np.genfromtxt(lines, delimiter=",", names=True)
        profiles[profile["name"]] = (
            columns[profile.pop("position_column")],
            columns[profile.pop("value_column")],
        )
    return problem, profiles


@pytest.fixture
def program():
    def run(*arguments):
        command = [os.environ["SLIDEWAY_PROGRAM"], *map(str, arguments)]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout

    return run


@pytest.fixture
def program_json(program):
    return lambda *arguments: json.loads(program(*arguments, "--curves", "--json", "-"))
