"""Builds the package with CMake and Ninja. Needs setuptools, and no network."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


class CMakeBuild(build_ext):
    """Makes the extension module in the project's own build. CMAKE_ARGS adds to its arguments."""

    def build_extension(self, extension):
        build = ROOT / "build/python"
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
             "-DBCCSKEL_BUILD_SERVER=OFF", "-DBCCSKEL_BUILD_TESTS=OFF", "-DBCCSKEL_PYTHON=ON",
             f"-DPython_EXECUTABLE={sys.executable}", *os.environ.get("CMAKE_ARGS", "").split()],
            check=True)
        subprocess.run(["cmake", "--build", build, "--target", "bccskel_python"], check=True)
        module = pathlib.Path(self.get_ext_fullpath(extension.name))
        module.parent.mkdir(parents=True, exist_ok=True)
        [built] = (build / "client/python/bccskel").glob("_native.*.so")
        shutil.copy(built, module)


version = re.search(r"project\(bccskel VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
setup(
    name="bccskel",
    version=version,
    description="Curve skeletons of masks, label images and meshes, with a proof of their topology",
    long_description=(HERE / "README.md").read_text(),
    long_description_content_type="text/markdown",
    packages=["bccskel"],
    package_data={"bccskel": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("bccskel._native", [])],
    cmdclass={"build_ext": CMakeBuild},
    python_requires=">=3.9",
    install_requires=["numpy"],
    extras_require={"graphs": ["networkx"], "tables": ["pandas"]},
)
