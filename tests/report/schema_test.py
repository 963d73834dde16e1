"""schema_test.py PROGRAM SOURCE: every report of every problem that ships is what the published
schema says. Exit code 77 where jsonschema is not installed."""

import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    sys.exit(77)

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
schemas = {name: json.loads((source / f"docs/{name}.schema.json").read_text(encoding="utf-8"))
           for name in ("report", "brief", "plan")}
for each in schemas.values():
    jsonschema.Draft202012Validator.check_schema(each)


def undeclared(value, schema, described, place=""):
    """Keys of a document that its schema does not describe."""
    if "anyOf" in described:
        described = described["anyOf"][0]
    if "$ref" in described:
        described = schema["$defs"][described["$ref"].rsplit("/", 1)[1]]
    if isinstance(value, list) and "items" in described:
        for index, each in enumerate(value):
            yield from undeclared(each, schema, described["items"], f"{place}[{index}]")
    if isinstance(value, dict) and "properties" in described:
        for key, each in value.items():
            if key not in described["properties"]:
                yield f"{place}.{key}"
            else:
                yield from undeclared(each, schema, described["properties"][key], f"{place}.{key}")


def faults(report):
    schema = schemas[report["schema"].split(".")[1].split("/")[0]]
    for error in jsonschema.Draft202012Validator(schema).iter_errors(report):
        yield f"{error.json_path}: {error.message}"
    yield from undeclared(report, schema, schema)


def reports():
    """Name and report of every problem by every command."""
    for problem in sorted(source.glob("problems/*/problem.toml")):
        for options in (["identify"], ["identify", "--no-trace"], ["fit"], ["rank"]):
            command = [program, *options, problem, "--json", "-"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if "slideway simulate" in done.stderr:  # its data are still to be made
                break
            done.check_returncode()
            yield f"{' '.join(options)} {problem.parent.name}", json.loads(done.stdout)
    problem = source / "problems/three-levels/problem.toml"
    with tempfile.TemporaryDirectory() as folder:
        manifest, results = pathlib.Path(folder, "m.csv"), pathlib.Path(folder, "r.jsonl")
        manifest.write_text(f"id,problem\na,{problem}\n", encoding="utf-8")
        subprocess.run([program, "batch", manifest, "--out", results, "--quiet"], check=True)
        yield "batch", json.loads(results.read_text(encoding="utf-8"))["report"]
        subprocess.run([program, "batch", manifest, "--out", f"{results}.full", "--full", "--quiet"],
                       check=True)
        yield "batch --full", json.loads(pathlib.Path(f"{results}.full").read_bytes())["report"]


def plan_faults(problem):
    command = [program, "plan", source / "problems" / problem / "problem.toml", "--json", "-"]
    plan = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    for error in jsonschema.Draft202012Validator(schemas["plan"]).iter_errors(plan):
        yield f"{error.json_path}: {error.message}"


failed = 0
for name, report in reports():
    for fault in faults(report):
        print(f"{name}: {fault}")
        failed += 1
for name in ("three-levels", "milling-machine-way"):
    for fault in plan_faults(name):
        print(f"plan {name}: {fault}")
        failed += 1
sys.exit(failed > 0)
