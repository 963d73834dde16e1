"""The notebook of the documents, cell by cell."""

import ast
import json

from conftest import ROOT

import slideway


def shown(cell, names):
    """Runs a cell; what its last line shows, if that is an expression."""
    tree = ast.parse("".join(cell["source"]))
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


def test_every_cell_runs_and_the_report_shows_itself(tmp_path, monkeypatch, capsys):
    notebook = json.loads((ROOT / "docs" / "face.ipynb").read_text(encoding="utf-8"))
    (tmp_path / "docs").mkdir()
    (tmp_path / "problems").symlink_to(ROOT / "problems")
    monkeypatch.chdir(tmp_path / "docs")
    names = {}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    results = [shown(cell, names) for cell in cells]
    assert isinstance(results[0], slideway.Report)
    assert "<table" in results[1]._repr_html_()
    assert "['thermal_drift']" in capsys.readouterr().out
    assert names["stages"]
    assert (tmp_path / "docs" / "face.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_no_output_is_stored():
    notebook = json.loads((ROOT / "docs" / "face.ipynb").read_text(encoding="utf-8"))
    assert not any(cell.get("outputs") for cell in notebook["cells"])
