#!/usr/bin/env python3
"""quality_table.py CASES.jsonl: docs/quality.md from what bench/quality printed."""

import collections
import json
import statistics
import sys

CATALOGUE = """linear_drift thermal_drift time_periodic tool_wear tool_running_in slide_periodic
revolution_periodic step centre_height speed_effect edge_roll_off traverse_datum centre_step
traverse_periodic""".split()
OPEN = "stretched_exponential chirp double_bump switched_drift".split()
CLOCK = {"stretched_exponential": "t", "switched_drift": "t", "chirp": "r", "double_bump": "r"}
FORM = {"stretched_exponential": "stretched exponential", "switched_drift": "kink",
        "chirp": "chirp", "double_bump": "bump + bump"}
ON_CLOCK = {"t": {"linear_drift", "thermal_drift", "time_periodic", "revolution_periodic"},
            "r": {"slide_periodic", "step", "centre_height", "speed_effect", "edge_roll_off", "cup",
                  "straightness"}}
SIGNATURE = {"feed_marks"}  # every turned face has them: finding them is not a false alarm
TWIN = {"time_periodic": "revolution_periodic", "revolution_periodic": "time_periodic"}


def share(part, whole):
    return f"{part}/{whole}" + (f" ({100 * part / whole:.0f} %)" if whole else "")


def named(case):
    return [name for name in case["accepted"] if name not in SIGNATURE]


def found(case):
    return case["truth"] in case["accepted"] + case["rivals"]


def is_wrong_alone(case):
    """a name that is not the truth's, whether or not the truth's stands beside it"""
    truth = case["truth"]
    return not case["rivals"] and bool(set(named(case)) - {truth, TWIN.get(truth)})


def squareness_holds(cases):
    """Whether Δβxz ± U holds the truth, wherever a U is given."""
    return [abs(c["bias_after"]) <= c["U_after"] for c in cases if c["U_after"] > 0]


def size_holds(cases):
    return [abs(c["found_um"][0] - c["truth_value"]) <= c["found_um"][1]
            for c in cases if c.get("found_um") and c["found_um"][1] > 0]


def row(label, cases):
    above = [c for c in cases if c.get("limit") and c["truth_value"] >= 2 * c["limit"]]
    below = [c for c in cases if c not in above]
    in_set = [c for c in above if found(c)]
    single = [c for c in above if c["truth"] not in TWIN]
    alone = [c for c in single if c["truth"] in c["accepted"] and not c["rivals"]]
    near = [c for c in cases if c.get("limit") and 0.8 <= c["truth_value"] / c["limit"] < 1.25]
    found_near = [c for c in near if found(c)]
    bias = squareness_holds(in_set)
    size = size_holds(above)
    bent = [c for c in in_set if abs(c["bias_before"]) > 5 * c["u_after"]]
    fall = [1 - abs(c["bias_after"]) / abs(c["bias_before"]) for c in bent]
    return [label, str(len(cases)), share(len(in_set), len(above)),
            share(len(alone), len(single)) if single or not above else "twins",
            share(sum(map(is_wrong_alone, above)), len(above)),
            share(sum(map(is_wrong_alone, below)), len(below)), share(len(found_near), len(near)),
            f"{sum(size)}/{len(size)}" if size else "",
            f"{sum(bias)}/{len(bias)}" if bias else "",
            f"{100 * statistics.median(fall):.0f} %" if fall else ""]


def at_limit_row(label, cases):
    return [label, share(sum(map(found, cases)), len(cases))]


def verdict_of(case):
    """Column of the confusion matrix: the first name that is not of every face, else the verdict."""
    names = named(case)
    return names[0] if names else "unnamed" if case["verdict"] == "unnamed" else "nothing"


def confusion(groups, cuts):
    """Cases by hidden effect and first name: how many had it alone, how many with rivals."""
    truths = [n for n in CATALOGUE + OPEN + ["clean"] if groups[cuts, n]]
    seen = {verdict_of(c) for n in truths for c in groups[cuts, n]}
    columns = [n for n in CATALOGUE + sorted(seen - set(CATALOGUE) - {"unnamed", "nothing"})
               + ["unnamed", "nothing"] if n in seen]
    rows = []
    for name in truths:
        cells = []
        for column in columns:
            own = [c for c in groups[cuts, name] if verdict_of(c) == column]
            rivals = sum(bool(c["rivals"]) for c in own)
            cells.append("" if not own else f"{len(own)}" if column in ("unnamed", "nothing")
                         else f"{len(own) - rivals}+{rivals}")
        rows.append([f"`{name}`"] + cells)
    return table(["hidden"] + [f"`{c}`" for c in columns], rows)


def coverage(cases):
    """How many expanded uncertainties (95 %) hold the truth after the loop has chosen the model."""
    dbeta, size = squareness_holds(cases), size_holds(cases)
    return (f"Within U after selection: Δβxz in {share(sum(dbeta), len(dbeta))} of all cases, "
            f"the size of the accepted effect in {share(sum(size), len(size))}.\n")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(r) + " |" for r in rows])


def main():
    cases = [json.loads(line) for line in open(sys.argv[1])]
    groups, at_limit = collections.defaultdict(list), collections.defaultdict(list)
    for case in cases:
        (at_limit if case["at_limit"] else groups)[case["cuts"], case["truth"]].append(case)
    print(open("bench/quality_head.md").read())
    print(f"{len(cases)} cases in these tables; each says how many are its own.\n")
    for cuts in sorted({c["cuts"] for c in cases}, reverse=True):
        print(f"## {cuts} cut{'s' if cuts > 1 else ''}\n")
        clean = groups[cuts, "clean"]
        false = [c for c in clean if named(c)]
        unnamed = [c for c in clean if c["verdict"] == "unnamed"]
        print(f"Nothing hidden: {share(len(false), len(clean))} named an effect that is not there "
              f"(feed marks apart), {share(len(unnamed), len(clean))} called noise structure, "
              f"{share(sum(bool(c.get('forms')) for c in clean), len(clean))} got a formula.\n")
        head = ["hidden effect", "cases", "in the set, >= 2 limits", "named alone, >= 2 limits",
                "wrong name alone, >= 2 limits", "below", "found at 0.8 to 1.25 limits",
                "size within U", "Δβxz within U", "bias removed"]
        rows = [row(f"`{n}`", groups[cuts, n]) for n in CATALOGUE if groups[cuts, n]]
        print(table(head, rows + [row("all", [c for n in CATALOGUE for c in groups[cuts, n]])]) + "\n")
        rows = []
        for name in OPEN:
            own = [c for c in groups[cuts, name] if c["size"] >= 5]
            if not own:
                continue
            no_name = [c for c in own if c["verdict"] == "unnamed"]
            right = [c for c in own if c["verdict"] != "unnamed" and named(c)
                     and set(named(c)) <= ON_CLOCK[CLOCK[name]]]
            among = [c for c in own if c["verdict"] != "unnamed" and c not in right
                     and set(named(c) + c["rivals"]) & ON_CLOCK[CLOCK[name]]]
            variable = [c for c in no_name if c["clock"] == CLOCK[name]]
            form = [c for c in no_name if FORM[name] in [f[0] for f in c.get("forms", [])[:3]]]
            rows.append([f"`{name}`", str(len(own)), share(len(no_name), len(own)),
                         share(len(variable), len(no_name)), share(len(form), len(no_name)),
                         share(len(right), len(own)), share(len(among), len(own))])
        if rows:
            print("Shapes in no catalogue, from 5 times the noise up:\n")
            print(table(["shape", "cases", "unnamed", "of these: right variable",
                         "form among first three", "named over the right variable",
                         "right variable among rivals"], rows) + "\n")
        print(coverage([c for n in CATALOGUE + ["clean"] for c in groups[cuts, n]]))
        print("First name given (alone + with rivals), by what was hidden:\n")
        print(confusion(groups, cuts) + "\n")
        rows = [at_limit_row(f"`{n}`", at_limit[cuts, n]) for n in CATALOGUE if at_limit[cuts, n]]
        if rows:
            rows.append(at_limit_row("all", [c for n in CATALOGUE for c in at_limit[cuts, n]]))
            print("At the stated detection limit (wanted: 80 % found):\n")
            print(table(["hidden effect", "found"], rows) + "\n")


if __name__ == "__main__":
    main()
