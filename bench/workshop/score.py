"""One case: written, identified, and what the report says of it held against the truth."""

import json
import math
import os
import re
import subprocess
import tempfile
import threading
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from shop import Case, Hidden, write

Record = dict[str, Any]
OF_EVERY_FACE = {"feed_marks"}  # every turned face has them: finding them is no false alarm
TIME_LIMIT = 600.0


def run(program: str, problem: Path) -> Record:
    """Status, seconds of processor time and the report, or the refusal."""
    report, errors = problem.with_name("result.json"), problem.with_name("messages.txt")
    command = [program, "identify", str(problem), "--quiet", "--json", str(report)]
    began = time.monotonic()
    with errors.open("w") as messages:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=messages)
        stop = threading.Timer(TIME_LIMIT, process.kill)
        stop.start()
        _, status, used = os.wait4(process.pid, 0)  # processor time of this child alone
        stop.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    timing = {"seconds": round(used.ru_utime + used.ru_stime, 3),
              "elapsed": round(time.monotonic() - began, 3)}
    if process.returncode == 0:
        return {"status": "done", "report": json.loads(report.read_text()), **timing}
    if timing["elapsed"] >= TIME_LIMIT:
        return {"status": "out of time", **timing}
    said = [line for line in errors.read_text().splitlines() if not line.startswith("WARNING")]
    message = (said or [f"exit {process.returncode}"])[0]
    return {"status": "refused" if process.returncode in (2, 3) else "failed",
            "message": message.replace(f"{problem.parent}/", ""), **timing}


def effect_of(label: str) -> str:
    """The effect's name of a label such as `step (cut2)` or `step.height_um`."""
    return re.match(r"[a-z_]*", label).group()  # type: ignore[union-attr]


def said(report: Record) -> list[Record]:
    """Every name the loop gives, blunders too: with rivals, and the profiles it is in where told."""
    rounds = report["trace"]["rounds"]
    names = [{"name": effect_of(one["accepted"]),
              "rivals": [effect_of(rival) for rival in one["ambiguous_with"]],
              "profiles": one.get("profiles") or []}
             for one in rounds if effect_of(one["accepted"]) not in OF_EVERY_FACE]
    blunders = report["trace"].get("blunders") or []
    labels = [f"{one['what']} of {one['profile']}" for one in blunders]
    if labels:
        names.append({"name": labels[0], "rivals": labels[1:], "profiles": [blunders[0]["profile"]]})
    return names


def is_right(hidden: Hidden, name: str) -> bool:
    """Is the name one of what is hidden, or its blunder in its profile?"""
    if name in hidden.names:
        return True
    return bool(hidden.words and re.search(f"{hidden.words}.* of {hidden.cuts[0]}$", name))


def parameter(report: Record, name: str) -> Record | None:
    found = [p for p in report["final"]["parameters"] if p["name"] == name]
    return found[0] if found and found[0]["identifiable"] else None


def within(estimate: Record | None, truth: float) -> Record | None:
    """Error and expanded uncertainty, where the report gives one."""
    if estimate is None or not estimate.get("expanded_uncertainty"):
        return None
    value = estimate["value"]
    return {"error": value - truth, "U": estimate["expanded_uncertainty"]}


def limit(report: Record, hidden: Hidden) -> float | None:
    """The stated detection limit of the effect at its shape, between those printed by logarithms."""
    limits = report["trace"].get("detection_limits", [])
    stated = [x for x in limits if x["effect"] == hidden.names[0]]
    if not stated or stated[0]["value"] is None:
        return None
    points = [(math.log(p["shape"]), math.log(p["value"])) for p in stated[0]["by_shape"]
              if p["value"] and p["shape"] > 0]
    if not points or hidden.shape <= 0:
        return float(stated[0]["value"])
    points.sort()
    at = math.log(hidden.shape)
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= at <= x1:
            return math.exp(y0 + (y1 - y0) * (at - x0) / (x1 - x0))
    return math.exp(points[0][1] if at < points[0][0] else points[-1][1])


def unseen(report: Record) -> float:
    """By how much what the data do not show may move Δβxz, rad: the largest the report states."""
    moved = [x["squareness_rad"] for x in report["trace"].get("detection_limits", [])]
    return max((abs(x) for x in moved if x is not None), default=0.0)


def size_of(report: Record, hidden: Hidden) -> Record | None:
    """Size of the effect where it was accepted under its own name."""
    if not hidden.parameter:
        return None
    estimate = parameter(report, f"{hidden.names[0]}.{hidden.parameter}")
    signed = hidden.names[0] not in ("slide_periodic", "time_periodic", "revolution_periodic",
                                     "traverse_periodic")
    if estimate is not None and not signed:
        estimate = estimate | {"value": abs(estimate["value"])}
    return within(estimate, hidden.size)


def judge(report: Record, case: Case) -> Record:
    """What the report says, and whether it is true."""
    names = said(report)
    wrong = [one["name"] for one in names
             if not one["rivals"] and not any(is_right(h, one["name"]) for h in case.hidden)]
    listed = [name for one in names for name in [one["name"], *one["rivals"]]]
    hidden_ones = []
    for hidden in case.hidden:
        own = [one for one in names if is_right(hidden, one["name"])]
        hidden_ones.append(asdict(hidden) | {
            "in_set": any(is_right(hidden, name) for name in listed),
            "alone": any(all(is_right(hidden, rival) for rival in one["rivals"]) for one in own),
            "with_cut": any(sorted(one["profiles"]) == sorted(hidden.cuts) for one in own),
            "limit": limit(report, hidden) if hidden.parameter else None,
            "found": size_of(report, hidden)})
    dbeta = within(parameter(report, "squareness.dbeta_xz"), case.shop.squareness)
    if dbeta is not None:
        dbeta["unseen"] = unseen(report)
    apart = [check["profiles"] for check in report["crosscheck"]["profiles"]
             if check["verdict"] == "inconsistent"]
    return {"verdict": report["trace"]["verdict"], "names": names, "wrong": wrong, "dbeta": dbeta,
            "hidden": hidden_ones, "apart": apart}


def score(case: Case, program: str, title: str, keep: Path | None) -> Record:
    """Writes the case (to keep, where given), runs it, and scores the report."""
    with tempfile.TemporaryDirectory() as scratch:
        outcome = run(program, write(case, keep or Path(scratch), title))
    report = outcome.pop("report", None)
    if report is not None:
        try:
            outcome |= judge(report, case)
        except (KeyError, TypeError) as fault:
            outcome |= {"status": "failed", "message": f"unexpected report: {fault!r}"}
    return outcome
