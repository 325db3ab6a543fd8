"""`pip install --no-build-isolation ./experiments/python`: builds the module with CMake.

FARCULL_BUILD names a build folder of farcull to use; default build-python beside the sources.
CMAKE_ARGS: more arguments for CMake.
"""

import os
import pathlib
import shlex
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.dist import Distribution

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Build(build_py):
    """Puts the compiled module beside the files of the package."""

    def run(self):
        super().run()
        if not (ROOT / "core").is_dir():
            raise SystemExit("farcull: the sources are not here; install from a checkout of farcull")
        folder = pathlib.Path(os.environ.get("FARCULL_BUILD", ROOT / "build-python"))
        configure = ["cmake", "-S", str(ROOT), "-B", str(folder), "-DFARCULL_PYTHON=ON"]
        if not (folder / "CMakeCache.txt").exists():
            configure += [
                "-DFARCULL_TESTS=OFF",
                f"-DPython3_EXECUTABLE={sys.executable}",
                *shlex.split(os.environ.get("CMAKE_ARGS", "")),
            ]
            subprocess.run(configure, check=True)
        subprocess.run(
            ["cmake", "--build", str(folder), "--target", "farcull_python"], check=True
        )
        built = list((folder / "python" / "farcull").glob("_farcull.*.so"))
        if len(built) != 1:
            raise SystemExit(f"farcull: {folder}/python holds {len(built)} modules; remove it")
        target = pathlib.Path(self.build_lib) / "farcull"
        self.mkpath(str(target))
        self.copy_file(str(built[0]), str(target))


class Compiled(Distribution):
    """Marks the wheel as one for this Python and this kind of machine."""

    def has_ext_modules(self):
        return True


setup(
    name="farcull",
    version="0.1",
    description="Collision culling that never misses",
    packages=["farcull"],
    package_data={"farcull": ["py.typed", "*.pyi"]},
    python_requires=">=3.9",
    install_requires=["numpy"],
    cmdclass={"build_py": Build},
    distclass=Compiled,
    zip_safe=False,
)
