"""What stands beside the module: stubs, docstrings, the example in README."""

import ast
import inspect
import pathlib
import re
import subprocess
import sys

from conftest import ROOT

import slideway
from slideway import _slideway

FOLDER = pathlib.Path(slideway.__file__).parent


def test_stubs_are_those_of_the_compiled_half():
    stub = ast.parse((FOLDER / "_slideway.pyi").read_text())
    functions = {
        node.name: [argument.arg for argument in node.args.args]
        for node in stub.body
        if isinstance(node, ast.FunctionDef)
    }
    names = {name for name in vars(_slideway) if not name.startswith("__")}
    assert names == functions.keys() | {
        node.name for node in stub.body if isinstance(node, ast.ClassDef)
    }
    for name, arguments in functions.items():
        signature = vars(_slideway)[name].__doc__.splitlines()[0]  # f(a: x, b: y) -> z
        assert re.findall(r"(\w+): ", signature) == arguments
    assert (FOLDER / "py.typed").exists()


def test_everything_public_is_described_and_typed():
    for name in slideway.__all__:
        public = getattr(slideway, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(public), name
        assert public.__module__ in ("slideway", "slideway._typed", "slideway.report"), name
        if inspect.isfunction(public):
            signature = inspect.signature(public)
            assert signature.return_annotation is not inspect.Signature.empty, name
            for parameter in signature.parameters.values():
                assert parameter.annotation is not inspect.Parameter.empty, name


def test_version_is_the_program_s(program):
    assert program("--version") == f"slideway {slideway.__version__}\n"


def test_readme_shows_an_example_and_what_it_says():
    readme = (ROOT / "docs/library.md").read_text(encoding="utf-8")
    example, said = re.search(r"```python\n(.*?)```\n.*?```text\n(.*?)```\n", readme, re.S).groups()
    run = subprocess.run([sys.executable, "-B", "-c", example], cwd=ROOT, check=True,
                         capture_output=True, text=True)  # fmt: skip
    assert run.stdout == said
