"""How a report shows itself: at a prompt, in a notebook, as a picture, a page, a file."""

from __future__ import annotations

import html
import math
import os
import pathlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from slideway import _slideway

if TYPE_CHECKING:
    from slideway.report import ModelResult, Parameter, Trace

_COLUMNS = ("name", "value", "expanded_uncertainty", "unit", "coverage_factor")


class Parameters(list["Parameter"]):
    """The final parameters: a list, a table in a notebook, a data frame where pandas is there."""

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``, a row for each parameter, its name the index.

        :raises ImportError: there is no pandas
        """
        import pandas

        rows = [{column: getattr(each, column) for column in _COLUMNS} for each in self]
        return pandas.DataFrame(rows, columns=list(_COLUMNS)).set_index("name")

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{html.escape(each.name)}</th><td>{_said(each)}</td>"
            f"<td>{html.escape(each.unit)}</td></tr>"
            for each in self
        )
        head = "<tr><th>parameter</th><th>value ± U</th><th>unit</th></tr>"
        return f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>"


def _said(parameter: Parameter) -> str:
    value, uncertainty = parameter.value, parameter.expanded_uncertainty
    if value is None or uncertainty is None or math.isnan(value):
        return "not determined"
    return html.escape(_slideway.value_text(value, uncertainty))


class Shown:
    """What a report can do besides holding values."""

    if TYPE_CHECKING:
        title: str
        text: str
        json: str
        final: ModelResult | None
        trace: Trace | None
        curves: Any

    def __str__(self) -> str:
        """The box of the program's report: verdict, results, checks, next step."""
        return "\n".join(line for line in self.text.splitlines() if line.startswith("│"))

    def __repr__(self) -> str:
        verdict = self.trace.verdict if self.trace is not None else None
        return f"<slideway.Report {self.title!r}, verdict {verdict!r}>"

    @property
    def parameters(self) -> Parameters:
        """The final parameters; none of a ranking."""
        return Parameters(self.final.parameters if self.final is not None else [])

    def html(self) -> str:
        """The page of ``slideway identify --html``."""
        return _slideway.page(self.json)

    def svg(self) -> str:
        """One picture: a profile, the model, and what each model leaves of it."""
        return _slideway.picture(self.json)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file; its ending says what: .json, .html, .svg, .txt.

        :raises UsageError: another ending
        """
        path = pathlib.Path(path)
        made: dict[str, Callable[[], str]] = {
            ".json": lambda: self.json,
            ".html": self.html,
            ".svg": self.svg,
            ".txt": lambda: self.text,
        }
        if path.suffix not in made:
            raise _slideway.UsageError(f"{path}: accepted endings: {', '.join(made)}")
        path.write_text(made[path.suffix](), encoding="utf-8", newline="\n")

    def plot(self, profile: str | None = None) -> Any:
        """A ``matplotlib`` figure of a profile: the low band with the final model, and the residual
        of the declared and of the final model.

        :param profile: its name; default the first
        :raises ImportError: there is no matplotlib
        :raises UsageError: no profile of this name
        """
        from matplotlib import pyplot

        names = [each.profile for each in self.curves.profiles]
        if profile is not None and profile not in names:
            raise _slideway.UsageError(f"no profile {profile!r}; accepted: {', '.join(names)}")
        shown = self.curves.profiles[names.index(profile) if profile is not None else 0]
        figure, (form, rest) = pyplot.subplots(2, 1, sharex=True)
        extended = len(shown.model_after) > 0
        form.plot(shown.position_mm, shown.low_band, "k", label="low band")
        model = shown.model_after if extended else shown.model_before
        form.plot(shown.position_mm, model, "C0", label="final model")
        rest.plot(shown.position_mm, shown.residual_before, "C1", label="declared model")
        if extended:
            rest.plot(shown.position_mm, shown.residual_after, "C0", label="final model")
        quantity = "slope" if shown.unit == "urad" else "height"
        form.set(title=shown.profile, ylabel=f"{quantity}, {shown.unit}")
        rest.set(xlabel="trace position, mm", ylabel=f"residual, {shown.unit}")
        for axes in (form, rest):
            axes.legend()
        return figure

    def _repr_svg_(self) -> str | None:
        return self.svg() if self.curves is not None and self.curves.profiles else None

    def _repr_html_(self) -> str:
        box = f"<pre>{html.escape(str(self))}</pre>"
        return box + self.parameters._repr_html_() + (self._repr_svg_() or "")
