"""`pip install --no-build-isolation ./experiments/python`: builds the module with CMake.

FARCULL_BUILD names the build folder, relative to the folder where pip was called or to the top of the
sources. The default is build-python at the top of the sources. CMAKE_ARGS: more arguments for CMake.
`pip install -v` shows the progress.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.dist import Distribution

ROOT = pathlib.Path(__file__).resolve().parents[2]


VERSION = re.search(
    '__version__ = "(.*)"', (ROOT / "experiments/python/farcull/__init__.py").read_text()
).group(1)


def build_folder():
    named = os.environ.get("FARCULL_BUILD")
    if not named:
        return ROOT / "build-python"
    # pip changes into the folder of this file; PWD still names the caller's folder.
    for base in (pathlib.Path(os.environ.get("PWD", ".")), ROOT, pathlib.Path.cwd()):
        if (base / named / "CMakeCache.txt").exists():
            return base / named
    raise SystemExit(f"farcull: FARCULL_BUILD={named} is no build folder; give its whole path")


class Build(build_py):
    """Puts the compiled module beside the files of the package."""

    def run(self):
        super().run()
        if not (ROOT / "core").is_dir():
            raise SystemExit("farcull: the sources are not here; install from a checkout of farcull")
        folder = build_folder()
        configure = ["cmake", "-S", str(ROOT), "-B", str(folder), "-DFARCULL_PYTHON=ON"]
        if not (folder / "CMakeCache.txt").exists():
            configure += [
                "-DFARCULL_TESTS=OFF",
                f"-DPython3_EXECUTABLE={sys.executable}",
                *(["-GNinja"] if shutil.which("ninja") else []),
                *shlex.split(os.environ.get("CMAKE_ARGS", "")),
            ]
            subprocess.run(configure, check=True)
        jobs = str(len(os.sched_getaffinity(0)))
        subprocess.run(
            ["cmake", "--build", str(folder), "--target", "farcull_python", "-j", jobs], check=True
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
    version=VERSION,
    description="Collision culling that never misses",
    packages=["farcull"],
    package_data={"farcull": ["py.typed"]},
    python_requires=">=3.9",
    install_requires=["numpy"],
    cmdclass={"build_py": Build},
    distclass=Compiled,
    zip_safe=False,
)
