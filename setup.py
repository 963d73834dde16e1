"""The Python package as a wheel; its module is built by CMake.

SLIDEWAY_BUILD_DIR is the folder CMake builds in, made where there is none (build/wheel).
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("SLIDEWAY_BUILD_DIR", SOURCE / "build/wheel"))
MADE = SOURCE / "build/setuptools"


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        if not (BUILD / "CMakeCache.txt").exists():
            subprocess.run(
                ["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release",
                 "-D", "CMAKE_UNITY_BUILD=ON", "-D", "SLIDEWAY_TESTS=OFF", "-D", "SLIDEWAY_PYTHON=ON",
                 "-D", f"Python3_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "slideway_python"], check=True)
        module, = (BUILD / "python/slideway").glob("_slideway*.so")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(module, target)


def version():
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(slideway VERSION ([\d.]+)", text)[1]


MADE.mkdir(parents=True, exist_ok=True)
setup(version=version(), ext_modules=[Extension("slideway._slideway", [])],
      cmdclass={"build_ext": CMakeBuild},
      options={"egg_info": {"egg_base": str(MADE)}, "build": {"build_base": str(MADE)}})
