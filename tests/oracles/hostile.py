"""Files of strangers in each format, damaged in small ways, and the program in unusual surroundings: a full disk, little memory or
stack, a decimal comma, no HOME, no /proc, one CPU, standard input. Either the answer is that of the same scene without damage, or
there is an error that says so; never a crash."""
import atexit
import functools
import gzip
import json
import os
import resource
import struct
import subprocess
import time

import farcull
import numpy as np

from . import exact
from .lab import BOXES_OPTION, HERE, all_pairs, call, dropped, indexed, off, read_json, require, rows, starts_of, write

FAULTS = ["a dropped pair", "another corner"]
SECONDS = 5  # of CPU time for a file of some hundred bytes
NUMBERS = ["1", "2", "3", "0.5", "nan", "inf", "-inf", "1e999", "1e-999", "-1", "0", "4294967296", "99999999999",
           "9" * 400, "0x10", "1,5", "", "1e", "--1"]


def obj(V, F):
    return "".join("v %r %r %r\n" % tuple(v) for v in V) + "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in F)


def stl(V, F):
    facet = "facet normal 0 0 0\nouter loop\n" + "vertex %r %r %r\n" * 3 + "endloop\nendfacet\n"
    return "solid a\n" + "".join(facet % tuple(x for i in f for x in V[i]) for f in F) + "endsolid a\n"


def binary_stl(V, F):
    return b"binary".ljust(80) + struct.pack("<I", len(F)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for i in f for x in V[i]), 0) for f in F)


def ply(order):
    def make(V, F):
        head = (f"ply\nformat {order} 1.0\nelement vertex {len(V)}\nproperty double x\nproperty double y\nproperty double z\n"
                f"element face {len(F)}\nproperty list uchar int vertex_indices\nend_header\n")
        if order == "ascii":
            return head + "".join("%r %r %r\n" % tuple(v) for v in V) + "".join("3 %d %d %d\n" % tuple(f) for f in F)
        end = "<" if order == "binary_little_endian" else ">"
        return head.encode() + b"".join(struct.pack(end + "3d", *v) for v in V) + b"".join(
            struct.pack(end + "B3i", 3, *f) for f in F)
    return make


FORMATS = {"off": off, "obj": obj, "stl": stl, "bin.stl": binary_stl, "ply": ply("ascii"), "le.ply": ply("binary_little_endian"),
           "be.ply": ply("binary_big_endian")}


def harmless(rng, ending, text):
    """Another text with the same meaning."""
    lines = text.split("\n")
    what = rng.choice(["line ends", "blanks", "comment", "none"])
    if what == "line ends":
        return text.replace("\n", "\r\n")
    if what == "blanks" and ending in ("off", "obj", "stl"):
        return "\n".join(line.replace(" ", rng.choice(["  ", "\t"])) + rng.choice(["", " "]) for line in lines)
    if what == "comment" and ending in ("off", "obj"):
        k = rng.randint(1, len(lines) - 1)
        return "\n".join([*lines[:k], "# 1 2 3", *lines[k:]])
    if what == "comment" and ending == "ply":
        return text.replace("\nelement face", "\ncomment element vertex 7\nelement face")
    return text


def damaged(rng, data):
    """Bytes that were changed in one to three places."""
    for _ in range(rng.choice([1, 1, 2, 3])):
        k = rng.randrange(len(data) + 1)
        what = rng.randrange(7)
        if what == 0:
            data = data[:k]
        elif what == 1:
            data = data[:k] + bytes([rng.randrange(256)]) + data[k + 1 :]
        elif what == 2:
            data = data[:k] + rng.choice(NUMBERS).encode() + data[k:]
        elif what == 3:
            words = data.split(b" ")
            words[rng.randrange(len(words))] = rng.choice(NUMBERS).encode()
            data = b" ".join(words)
        elif what == 4:
            lines = data.split(b"\n")
            j = rng.randrange(len(lines))
            lines[j : j + 1] = rng.choice([[], [lines[j]] * 2, [lines[j] * (300 if len(data) < 10000 else 2)]])
            data = b"\n".join(lines)
        elif what == 5:
            data = data[:k] + struct.pack("<I", rng.choice([0, 1 << 31, (1 << 32) - 1, 1 << 24])) + data[k + 4 :]
        else:
            data = rng.choice([b"\xef\xbb\xbf", b"\xff\xfe", b"\0", b"\x1f\x8b"]) + data
        data = data or b"\n"
    return data


def scene(rng, spoil):
    started = time.process_time()
    sizes = [rng.randint(1, 4) for _ in range(2)]
    corners = np.array([[[rng.randint(0, 5) for _ in range(3)] for _ in range(3)] for _ in range(sum(sizes))])
    unit = float(rng.choice([1, 0.5, 2.0**-100, 2.0**100, -3]))  # a float holds all corners, since binary STL has no others
    files, ending = [], rng.choice(list(FORMATS))
    for k, (start, size) in enumerate(zip(starts_of(sizes), sizes)):
        V, F = indexed(corners[start : start + size])
        data = FORMATS[ending]((V * unit).tolist(), F.tolist())
        data = (harmless(rng, ending, data) if isinstance(data, str) else data)
        data = data.encode() if isinstance(data, str) else data
        packed = rng.random() < 0.2
        files.append(write(f"{HERE}{k}.{ending}" + (".gz" if packed else ""), gzip.compress(data) if packed else data))
    a, b = all_pairs(sizes)
    meeting = exact.meet(corners[a], corners[b])
    expected = list(zip(a[meeting].tolist(), b[meeting].tolist()))
    if rng.random() < 0.05:
        return surroundings(rng, files, expected, sizes, ending)
    if rng.random() < 0.3 or spoil.fault:  # not damaged
        made = farcull.Scene(*files)
        read = np.asarray(made.vertices)[np.asarray(made.triangles)]
        read = spoil("another corner", read, lambda x: x + (x == x[0, 0, 0]) * unit)
        require((read == corners * unit).all(), f"read otherwise: {ending}", read, corners * unit)
        pairs = spoil("a dropped pair", rows(made.run(threads=1).pairs), dropped)
        require(pairs == expected, "pairs", pairs, expected)
        return {"files read as they are": len(files)}
    facts = {"damaged files": 1}
    what = rng.random()
    try:
        if what < 0.7:
            with open(files[0], "rb") as file:
                data = file.read()
            made = farcull.Scene(write(files[0], damaged(rng, data)), files[1])
            V, F = np.asarray(made.vertices), np.asarray(made.triangles)
            require(F.size == 0 or F.max() < len(V) and np.isfinite(V[F]).all(), "a corner that is not finite", files, F)
            made.run(threads=1)
        elif what < 0.85:
            text = {"objects": [{"name": "a", "mesh": os.path.basename(files[0]), "scale": 2, "translate": [1, 2, 3], "self": True},
                                {"mesh": os.path.basename(files[1]), "rotate": {"axis": [0, 0, 1], "angle": 1.5}, "split": "none"}],
                    "ignore": [["a", "1"]] if rng.random() < 0.3 else []}
            farcull.Scene(write(HERE + "s.json", damaged(rng, json.dumps(text).encode()))).run(threads=1)
        else:
            made = farcull.Scene(*files)
            farcull.check(made, damaged(rng, made.run(threads=1).certificate().encode()).decode("latin-1"))
        facts["damaged files that are read"] = 1
    except (farcull.Error, MemoryError) as error:
        require(isinstance(error, MemoryError) or (error.where and error.reason and error.remedy), "an error that says little", error)
    spent = time.process_time() - started
    require(spent < SECONDS, f"it took {spent} s", files)
    return facts


@functools.cache
def locales():
    """A folder with a locale of decimal commas, or None. The program is no Python, so the variables alone decide."""
    folder = HERE + "locales"
    os.makedirs(folder, exist_ok=True)
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder + "/de_DE.UTF-8"], capture_output=True, check=False)
    return folder if os.path.exists(folder + "/de_DE.UTF-8") and made.returncode in (0, 1) else None


@functools.cache
def small_disk():
    """A folder on a disk of 16 KiB, or None."""
    folder = HERE + "disk"
    os.makedirs(folder, exist_ok=True)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "oracle", folder], capture_output=True, check=False).returncode:
        return None
    atexit.register(subprocess.run, ["umount", folder], check=False)
    return folder


def surroundings(rng, files, expected, sizes, ending):
    """One command of the program as usual, and in a place where something is missing."""
    command = rng.choice([["run", *files, "--pairs", "-"], ["clash", *files, "--csv", "-"], ["distance", *files, "--csv", "-"],
                          ["run", *files, "--method", "far", BOXES_OPTION, "objects", "--resolution", "32", "--pairs", "-"]])
    status, plain, err = call(*command)
    require(status in (0, 1), "the program as usual", command, status, err)
    if command[0] == "run":
        starts = starts_of(sizes)
        lines = [f"0,{a},1,{b - starts[1]}" for a, b in expected]
        require(plain.splitlines()[1:] == lines, "pairs", plain, lines)

    def limits(what, most):
        return lambda: resource.setrlimit(what, (most, most))

    def same(got, why):
        require(got[0] == status and got[1] == plain, "another answer: " + why, command, got, plain)

    def same_or_error(got, why):
        """An error is one line; where the loader finds no memory, status 127."""
        good = got[:2] == (status, plain) or (got[0] in (2, 127) and got[1] == "" and len(got[2].splitlines()) == 1)
        require(good, why, command, got)
        return got[0] == status

    kind = rng.choice(["memory", "stack", "comma", "no home", "no cache", "no /proc", "one CPU", "full disk", "stdin", "list"])
    if kind == "memory":
        most = rng.randint(20, 300) << 20
        kind += " is enough" if same_or_error(call(*command, preexec_fn=limits(resource.RLIMIT_AS, most)), f"{most} bytes") else ""
    elif kind == "stack":
        most = rng.randint(64, 1024) << 10
        same_or_error(call(*command, preexec_fn=limits(resource.RLIMIT_STACK, most)), f"a stack of {most} bytes")
    elif kind == "comma":
        if not locales():
            return {"no locale of decimal commas": 1}
        same(call(*command, env={**os.environ, "LOCPATH": locales(), "LC_ALL": "de_DE.UTF-8"}), "decimal commas")
    elif kind == "no home":
        left = {k: v for k, v in os.environ.items() if k not in ("HOME", "XDG_CACHE_HOME")}
        same(call(*command, env=rng.choice([left, {**left, "HOME": "/proc/1/none"}, {**left, "HOME": ""}, {}])), kind)
    elif kind == "no cache":
        same(call(*command, env={**os.environ, "XDG_CACHE_HOME": rng.choice(["/dev/null", "/proc", "relative", files[0]])}), kind)
    elif kind == "no /proc":
        hidden = ["unshare", "-m", "sh", "-c", 'mount -t tmpfs none /proc && exec "$@"', "sh"]
        if can_hide():
            same(call(*command, before=hidden), kind)
    elif kind == "one CPU":
        same(call(*command, before=["taskset", "-c", "0"]), kind)
    elif kind == "full disk":
        if small_disk():
            try:
                write(small_disk() + "/filler", b"x" * rng.choice([0, 8 << 10, 16 << 10]))
            except OSError:
                pass
            out = small_disk() + "/out.json"
            got = call("run", *files, "--json", out)
            require(got[0] == 2 and "cannot be written" in got[2] or got[0] == 0 and read_json(out), "a full disk", got)
            if os.path.exists(out):
                os.remove(out)
    elif kind == "stdin":
        form = "stl" if "stl" in ending else "ply" if "ply" in ending else ending
        with open(files[0], "rb") as file:
            got = call(command[0], "-", files[1], *command[3:], "--format", form, stdin=file)
        require(command[0] == "clash" or got[:2] == (status, plain), "standard input", command, got, plain)  # which has names
        got = call(command[0], "-", files[1], *command[3:], "--format", form)
        require(got[0] == 2 and len(got[2].splitlines()) == 1, "an empty standard input", got)
    else:
        text = "object_a,triangle_a,object_b,triangle_b\n" + "".join(f"0,{a},1,{b - sizes[0]}\n" for a, b in expected)
        got = call("check", *files, "--pairs", write(HERE + "list.csv", damaged(rng, text.encode())))
        require(got[0] in (0, 1, 2), "a damaged list", got)
        with open(HERE + "list.csv", "rb") as file:
            data = file.read()
        got = call("run", *files, "--ignore-file", write(HERE + "ignored", data))
        require(got[0] in (0, 2), "a damaged file of ignored pairs", got)
    return {f"place: {kind}": 1}


@functools.cache
def can_hide():
    return call("-m", "sh", "-c", "mount -t tmpfs none /proc", program="unshare")[0] == 0
