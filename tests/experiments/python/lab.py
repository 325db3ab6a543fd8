"""What the tests of the module share. FARCULL_PROGRAM names the program."""
import os
import subprocess

import farcull
import numpy as np
import pytest

PROGRAM = os.environ["FARCULL_PROGRAM"]
ALL = dict(self=True, contacts=True)


def asked(*words):
    """What the program prints."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
    assert done.stdout and done.returncode in (0, 1), done.stderr
    return done.stdout


def error_of(call, *arguments, **options):
    with pytest.raises(farcull.Error) as caught:
        call(*arguments, **options)
    error = caught.value
    assert error.where and error.reason and error.remedy
    assert str(error) == f"{error.where}: {error.reason}; {error.remedy}"
    return error


def or_skip(call, *arguments, **options):
    """What the call returns. Where there is no OpenGL the test is skipped."""
    try:
        return call(*arguments, **options)
    except farcull.InputError:
        raise
    except farcull.Error as error:
        pytest.skip(f"no OpenGL here: {error}")


def refused(call, *arguments, **options):
    """Where the call says that an argument is wrong."""
    error = error_of(call, *arguments, **options)
    assert isinstance(error, farcull.InputError)
    return error.where


def same_pairs(a, b):
    return np.array_equal(a.pairs, b.pairs) and np.array_equal(a.neighbour_pairs, b.neighbour_pairs)
