"""slideway.Problem: a problem with types says what a dict of the same keys says."""

import dataclasses

import pytest
from conftest import problem_dict

import slideway
from slideway import Problem, Profile, Term

KEYS = {each.name for each in dataclasses.fields(Profile)}


def typed(name):
    problem, arrays = problem_dict(name)
    profiles = []
    for table in problem.pop("profile"):
        position, value = arrays[table["name"]]
        known = {key: table.pop(key) for key in list(table) if key in KEYS}
        profiles.append(Profile(position=position, value=value, more=table, **known))
    effects = [
        Term(name=table.pop("name"), degree=table.pop("degree", None), more=table)
        for table in problem.pop("effect")
    ]
    return Problem(profiles=profiles, effects=effects, title=problem.pop("title"), more=problem)


def test_a_problem_with_types_gives_the_report_of_the_dict():
    problem, arrays = problem_dict("paper-600mm/problem.toml")
    report = slideway.identify(typed("paper-600mm/problem.toml"), trace=False)
    assert report.json == slideway.identify(problem, arrays, trace=False).json


def test_what_is_not_given_is_no_key():
    profile = Profile(name="face", position=[1.0], value=[2.0], position_unit="mm")
    problem = Problem(profiles=[profile], effects=[Term(name="squareness")])
    assert problem.to_dict() == {
        "profile": [{"name": "face", "kind": "face", "position_unit": "mm"}],
        "effect": [{"name": "squareness"}],
    }


def test_a_fault_of_a_value_is_a_usage_error_with_its_place():
    profile = Profile(name="face", position=[1.0, 2.0], value=[2.0, 3.0], value_unit="um")
    problem = Problem(profiles=[profile], effects=[], machine={"lever": "paper"})
    with pytest.raises(slideway.UsageError, match=r"profile\[0\].position_unit: missing"):
        slideway.identify(problem)
    profile.value = None
    with pytest.raises(slideway.UsageError, match="face"):
        slideway.identify(problem)
