"""Tries the product against independent oracles, on random scenes. Called by tests/oracles.sh.

Each line is a module with FAULTS, names of faults that can be planted into the product's answers, and scene(rng, spoil), which
makes a random scene, asks the product, raises Wrong where the oracle differs, and returns what it saw as counts."""
import argparse
import importlib
import mmap
import os
import random
import signal
import struct
import sys
import time
import traceback
import warnings
from collections import Counter

LINES = {"oriented": 20000, "contained": 20000, "welded": 20000, "distances": 20000, "frames": 20000, "kinds": 20000,
         "certificates": 20000, "drawn": 10000, "options": 2000, "hostile": 20000}
PLANTED = 10  # of each fault, where there are ENOUGH scenes for them
ENOUGH = 100
TRIES = 3000  # scenes at most in which a fault is planted


def planted(line, lab, name, seed):
    """How many of PLANTED scenes show each fault. A fault that few scenes can have is tried in more of them."""
    good = True
    for fault in line.FAULTS:
        found = done = 0
        for k in range(TRIES):
            spoil = lab.Spoiler(fault)
            try:
                line.scene(random.Random(f"{name} {seed + k}"), spoil)
            except lab.Wrong:
                found += spoil.planted
            done += spoil.planted
            if done == PLANTED:
                break
        good &= done == PLANTED and found == done
        print(f"  twin: {fault}: found in {found} of {done} scenes{'' if found == done == PLANTED else ', FAILED'}", flush=True)
    return good


def run(name, scenes, seed, at):
    """In a process of its own, which notes the seed that it is at, so that a crash of the product is reported as well. Ctrl-C or
    SIGTERM ends the line, and what it saw until then is printed."""
    lab, line = (importlib.import_module("." + module, __package__) for module in ("lab", name))  # with a folder of their own
    counts, wrong, started, stopped = Counter(), 0, time.process_time(), []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopped.append(True))
    for k in range(scenes):
        at[:] = struct.pack("q", seed + k)
        if stopped:
            scenes = k
            break
        try:
            counts.update(line.scene(random.Random(f"{name} {seed + k}"), lab.Spoiler()))
        except Exception as error:
            wrong += 1
            if wrong <= 10:
                print(f"{name}: WRONG; {name} --seed {seed + k} --scenes 1 repeats it: {error!s}", flush=True)
                if not isinstance(error, lab.Wrong):
                    traceback.print_exc(limit=-1)
    words = ", ".join(f"{count:,} {what}" for what, count in sorted(counts.items()))
    print(f"{name}: {scenes:,} scenes from seed {seed}, {wrong} wrong, {time.process_time() - started:.0f} s; {words}", flush=True)
    return not stopped and wrong == 0 and (scenes < ENOUGH or planted(line, lab, name, seed))


def apart(name, scenes, seed):
    at = mmap.mmap(-1, 8)
    child = os.fork()
    if child == 0:
        sys.exit(0 if run(name, scenes, seed, at) else 1)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if status < 0:
        print(f"{name}: CRASH by signal {-status}; --seed {struct.unpack('q', at[:])[0]} --scenes 1 repeats it", flush=True)
    return status == 0


def main():
    parser = argparse.ArgumentParser(prog="tests/oracles.sh", description="Compares the product with independent oracles.")
    parser.add_argument("lines", nargs="*", metavar="LINE", help=f"of {', '.join(LINES)}; default all")
    parser.add_argument("--scenes", type=int, help="of each line; default 20,000, of drawn 10,000, of options 2,000")
    parser.add_argument("--seed", type=int, default=20261129)
    given = parser.parse_args()
    for line in given.lines:
        if line not in LINES:
            parser.error(f"no line is called {line}")
    warnings.simplefilter("ignore")  # of what a reader passed over or merged
    good = [apart(line, given.scenes or LINES[line], given.seed) for line in given.lines or LINES]
    sys.exit(0 if all(good) else 1)


main()
