"""pyproject.toml: a wheel built without network, installed into a clean environment."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import venv
import zipfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MISSING = [each for each in ("pip", "setuptools", "wheel") if importlib.util.find_spec(each) is None]
if MISSING:
    pytest.skip(f"not installed: python3-{', python3-'.join(MISSING)}", allow_module_level=True)

OFFLINE = ("--no-index", "--no-deps", "--no-cache-dir", "--disable-pip-version-check")


def run(*command):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, env=ENVIRONMENT)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


ENVIRONMENT = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built of a copy, so that nothing is written beside the sources; the module is the one built."""
    source = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "setup.py", "CMakeLists.txt", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    shutil.copytree(ROOT / "src/python", source / "src/python")
    run(sys.executable, "-m", "pip", "wheel", *OFFLINE, "--no-build-isolation", "-w", source, source)
    (made,) = source.glob("slideway-*.whl")
    return made


def test_a_wheel_holds_the_package_its_types_and_its_licence(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    package = {path.name for path in (ROOT / "src/python/slideway").iterdir() if path.is_file()}
    held = {pathlib.PurePath(name).name for name in names if name.startswith("slideway/")}
    modules = {name for name in held if name.endswith(".so")}
    assert held - modules == package
    assert len(modules) == 1
    assert any(name.endswith(".dist-info/LICENSE") for name in names)


def test_a_clean_environment_identifies_with_the_wheel(wheel, tmp_path):
    # numpy is the system's: there is no network to fetch another from.
    venv.create(tmp_path / "venv", system_site_packages=True, with_pip=False, symlinks=True)
    python = tmp_path / "venv/bin/python"
    run(sys.executable, "-m", "pip", "--python", python, "install", *OFFLINE, wheel)
    script = f"""
import importlib.metadata, slideway
print(slideway.__file__)
assert importlib.metadata.version("slideway") == slideway.__version__
print(slideway.identify({str(ROOT / "problems/demo/problem.toml")!r}).trace.verdict)
"""
    place, verdict = run(python, "-c", script).split()
    assert pathlib.Path(place).is_relative_to(tmp_path / "venv")
    assert verdict == "explained"
