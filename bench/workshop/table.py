"""Tables of docs/workshop.md: what was wanted, what was measured, and the worst case of each row."""

import statistics
from collections.abc import Callable
from typing import Any

Record = dict[str, Any]
Test = Callable[[Record], bool]
NO_TWIN = ("cup",)  # cup is b2 of the way on every face: no design of these tells them apart


def named(case: Record) -> bool:
    return bool(case["names"])


def wrong(case: Record) -> bool:
    return bool(case["wrong"])


def in_set(case: Record) -> bool:
    return all(hidden["in_set"] for hidden in case["hidden"])


def alone(case: Record) -> bool:
    return all(hidden["alone"] for hidden in case["hidden"])


def with_cut(case: Record) -> bool:
    return all(hidden["with_cut"] for hidden in case["hidden"])


def seen(case: Record) -> bool:
    return case["verdict"] != "nothing_missing"


def dbeta_held(case: Record) -> bool:
    return abs(case["dbeta"]["error"]) <= case["dbeta"]["U"]


def beyond_all(case: Record) -> bool:
    return abs(case["dbeta"]["error"]) > case["dbeta"]["U"] + case["dbeta"]["unseen"]


def above_limit(case: Record) -> bool:
    """Each effect at least twice the limit the program states for it."""
    return all(h["limit"] and abs(h["size"]) >= 2 * h["limit"] for h in case["hidden"])


def of_noise(times: float) -> Test:
    return lambda case: any(h["of_noise"] >= times for h in case["hidden"])


def worst(cases: list[Record]) -> str:
    """The failing case that is furthest off: by Δβxz, then by the size of what is hidden."""
    def badness(case: Record) -> tuple[float, float]:
        dbeta = case["dbeta"]
        off = abs(dbeta["error"]) / dbeta["U"] if dbeta else 0.0
        return (off, max((h["of_noise"] for h in case["hidden"]), default=0.0))
    if not cases:
        return ""
    case = max(cases, key=badness)
    off = badness(case)[0]
    return f"`{case['class']} {case['seed']}`" + (f", Δβxz {off:.1f} U off" if off > 1 else "")


def share(part: int, whole: int) -> str:
    return f"{part} of {whole} ({100 * part / whole:.1f} %)" if whole else "no case"


def row(what: str, wanted: str, cases: list[Record], test: Test, good: bool = True) -> list[str]:
    """One line: how many pass the test, and the worst of those that fail it (or pass, if not good)."""
    passed = [case for case in cases if test(case)]
    failed = [case for case in cases if case not in passed] if good else passed
    return [what, wanted, share(len(passed), len(cases)), worst(failed)]


def size_row(what: str, cases: list[Record]) -> list[str]:
    found = [h["found"] for case in cases for h in case["hidden"] if h["found"]]
    held = sum(abs(f["error"]) <= f["U"] for f in found)
    return [what, "92 to 97.5 %", share(held, len(found)), ""]


def dbeta_row(what: str, wanted: str, cases: list[Record]) -> list[str]:
    return row(what, wanted, [case for case in cases if case["dbeta"]], dbeta_held)


def statement(case: Record) -> tuple[str, tuple[tuple[str, ...], ...]]:
    """What a report says, whatever the figures: verdict and sets of names."""
    sets = sorted(tuple(sorted([one["name"], *one["rivals"]])) for one in case["names"])
    return case["verdict"], tuple(sets)


def stability_rows(cases: list[Record]) -> list[list[str]]:
    rows = []
    for name in dict.fromkeys(case["class"] for case in cases):
        said = [statement(case) for case in cases if case["class"] == name]
        most = max(set(said), key=said.count)
        names = " + ".join("/".join(one) for one in most[1])
        rows.append([f"the same statement, `{name}`", "16 of 20", share(said.count(most), len(said)),
                     f"{most[0]} {names}".strip() + f"; {len(set(said))} statements"])
    return rows


def wanted_rows(done: list[Record]) -> list[list[str]]:
    def group(*names: str) -> list[Record]:
        return [case for case in done if case["group"] in names]
    clean, ways = group("clean"), group("ways")
    lobes = [case for case in group("lobes") if of_noise(10)(case)]
    steps = [case for case in done if case["class"] == "step_in_one" and case["group"] == "one cut"]
    units = [c for c in done if c["class"] in ("wrong_sign", "inch", "thousand", "metres")]
    strong = [c for c in group("catalogue") if above_limit(c) and c["class"] not in NO_TWIN]
    two = [case for case in group("two") if above_limit(case)]
    single = [c for c in done if c["group"] == "one profile" or c["class"] == "one_profile"]
    shown = [c for c in single if above_limit(c)]  # of none, too
    three = [c for c in group("clean", "catalogue", "two") if c not in single]
    return [
        row("clean: an effect named", "≤ 2 %", clean, named, good=False),
        row("clean: a wrong name alone", "≤ 1 %", clean, wrong, good=False),
        row("clean: unnamed", "≤ 5 %", clean, lambda c: c["verdict"] == "unnamed", good=False),
        row("ways: a wrong name alone", "≤ 5 %", ways, wrong, good=False),
        dbeta_row("ways: Δβxz within U, where a U is given", "≥ 92 %", ways),
        row("lobes from ten times the noise: nothing missing", "never", lobes,
            lambda c: not seen(c), good=False),
        row("lobes from ten times the noise: named", "≥ 90 %", lobes, alone),
        row("step in one cut: seen", "≥ 95 %", steps, seen),
        row("step in one cut: named with its cut", "≥ 80 %", steps, with_cut),
        row("other events in one cut: a wrong name alone", "", [
            c for c in group("one cut") if c not in steps], wrong, good=False),
        row("blunders: a wrong name alone", "never", group("blunders"), wrong, good=False),
        row("blunders: sign and unit named", "≥ 95 %", units, alone),
        row("set-up: a wrong name alone", "", group("setup"), wrong, good=False),
        dbeta_row("set-up: Δβxz within U", "", group("setup")),
        row("growth by heat both ways: a wrong name alone", "", group("thermal"), wrong, good=False),
        row("catalogue from twice the limit: in the set", "≥ 98 %", strong, in_set),
        row("catalogue from twice the limit: a wrong name alone", "≤ 1 %", strong, wrong, good=False),
        row("two effects from twice the limit: both in the set", "≥ 85 %", two, in_set),
        row("one machine (clean, catalogue, two effects): profiles said to disagree", "≤ 4.55 %",
            group("clean", "catalogue", "two"), lambda c: bool(c["apart"]), good=False),
        dbeta_row("coverage after selection, three cuts: Δβxz", "92 to 97.5 %", three),
        size_row("coverage after selection, three cuts: size", three),
        dbeta_row("coverage after selection, one profile, nothing hidden or from twice the limit: Δβxz",
                  "92 to 97.5 %", shown),
        dbeta_row("one profile, beside an effect that it does not show: Δβxz within U", "",
                  [c for c in single if c not in shown]),
        size_row("coverage after selection, one profile: size", single),
        row("all classes: Δβxz off by more than U plus what unseen effects may move it", "never",
            [case for case in done if case["dbeta"] and case["group"] != "stability"],
            beyond_all, good=False),
    ] + stability_rows(group("stability"))


def class_row(name: str, cases: list[Record]) -> list[str]:
    """One class: verdicts, names and coverage."""
    done = [case for case in cases if case["status"] == "done"]
    verdicts = [case["verdict"] for case in done]
    counts = [f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts)]
    lost = [case["status"] for case in cases if case["status"] != "done"]
    counts += [f"{lost.count(s)} {s}" for s in dict.fromkeys(lost)]
    dbeta = [case for case in done if case["dbeta"]]
    hides = any(case["hidden"] for case in done)
    seconds = [case["seconds"] for case in cases]
    return [f"`{name}`", str(len(cases)), ", ".join(counts), str(sum(map(named, done))),
            str(sum(map(wrong, done))), str(sum(map(in_set, done))) if hides else "",
            str(sum(map(alone, done))) if hides else "",
            f"{sum(map(dbeta_held, dbeta))}/{len(dbeta)}",
            f"{statistics.median(seconds):.1f}", f"{max(seconds):.1f}"]


def markdown(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def lost_rows(cases: list[Record]) -> list[list[str]]:
    """Each way a run ended without a report: how often, and one case of it."""
    lost: dict[str, list[Record]] = {}
    for case in cases:
        lost.setdefault(f"{case['status']}: {case.get('message', '')}"[:160], []).append(case)
    return [[why, str(len(own)), f"`{own[0]['class']} {own[0]['seed']}`"]
            for why, own in lost.items()]


def page(cases: list[Record]) -> str:
    done = [case for case in cases if case["status"] == "done"]
    classes: dict[str, list[Record]] = {}
    for case in cases:
        if case["group"] != "stability":
            classes.setdefault(case["class"], []).append(case)
    lost = [case for case in cases if case not in done]
    silent = ["runs without a report", "never", share(len(lost), len(cases)), ""]
    text = markdown(["what", "wanted", "measured", "worst case"], [silent, *wanted_rows(done)])
    text += "\nBy class; \"in the set\" and \"alone\" are of all its cases, below the limit too:\n\n"
    text += markdown(["class", "cases", "verdicts", "named", "wrong name alone", "in the set",
                      "alone", "Δβxz within U", "median s", "longest s"],
                     [class_row(name, own) for name, own in classes.items()])
    if lost:
        text += "\nRuns without a report:\n\n"
        text += markdown(["why", "runs", "for example"], lost_rows(lost))
    return text
