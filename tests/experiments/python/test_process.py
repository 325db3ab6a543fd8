"""The module within its process: Ctrl-C, threads, fork, memory, interpreters. Each test runs a fresh
Python, so that what it breaks stays there."""
import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest


def python(code, **options):
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", textwrap.dedent(code)], capture_output=True,
                          text=True, check=False, timeout=120, **options)
    assert done.returncode == 0, f"status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


LARGE = """
    import farcull
    import numpy as np
    rng = np.random.default_rng(7)
    # Slivers through the unit cube, so that the exact tests alone take minutes.
    V = rng.uniform(size=(60000, 3))
    F = np.arange(60000).reshape(-1, 3)
"""


@pytest.mark.parametrize("call", [
    "farcull.collide(V, F, self=True)",
    # Few enough triangles that their pairs are not refused as too many.
    "farcull.distances(V, F[:2800], kind='all', within=1, self=True)",
    "farcull.Scene.from_arrays(V, F, self=True).run()",
    "list(farcull.Frames('cloth:20000', frames=1000))"])
def test_ctrl_c_ends_a_call(call):
    code = f"""
{textwrap.indent(textwrap.dedent(LARGE), "    ")}
    import signal
    import time
    # Where the test runs in the background of a shell, the signal is ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        print("begun", flush=True)
        {call}
    except KeyboardInterrupt:
        print("ended", time.monotonic(), flush=True)
    # What is left answers.
    print(farcull.collide([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [2, 1, 0]], [0, 1]).pairs)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begun\n"
        time.sleep(0.4)
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        out, _ = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 0
    assert out.startswith("ended ") and out.endswith("\n[[0 1]]\n"), out
    print(f"ended after {float(out.split()[1]) - start:.2f} s")


def test_arrays_that_another_thread_changes_meanwhile_are_answered_or_refused():
    out = python("""
    import farcull, threading
    import numpy as np
    rng = np.random.default_rng(13)
    V = (rng.normal(0, 9, size=(9000, 1, 3)) + rng.normal(0, 0.1, size=(9000, 3, 3))).reshape(-1, 3)
    F = np.arange(27000).reshape(-1, 3)
    ended = False

    def change():
        while not ended:
            F[5000], V[100] = (2**40, -5, 7), np.nan
            F[5000], V[100] = (1, 2, 3), 0.5

    changer = threading.Thread(target=change)
    changer.start()
    seen = {"answered": 0, "V": 0, "F": 0}
    for call in range(400):
        try:
            farcull.collide(V, F, [0, 4000], threads=1)
            seen["answered"] += 1
        except farcull.InputError as error:
            seen[error.where] += 1
        if call > 20 and min(seen.values()) > 0:
            break
    ended = True
    changer.join()
    print(min(seen.values()))
    """)
    assert int(out) > 0  # each was seen, else it shows nothing


def test_a_call_leaves_the_lock_to_other_threads():
    out = python(LARGE + """
    import threading
    done = threading.Event()
    threading.Thread(target=lambda: (farcull.collide(V[:9000], F[:1500], self=True), done.set())).start()
    steps = 0
    while not done.wait(0.001):
        steps += 1
    print(steps)
    """)
    assert int(out) > 20


def test_a_forked_process_answers_and_refuses_colliders_of_its_parent():
    python("""
    import farcull, os
    V, F = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [2, 1, 0]]
    scene = farcull.Scene("two-tori")
    expected = scene.run().pairs  # starts the threads that the fork does not have
    collider = farcull.Collider()
    child = os.fork()
    if child == 0:
        try:
            assert (scene.run().pairs == expected).all()
            assert farcull.collide(V, F, [0, 1]).pairs.tolist() == [[0, 1]]
            try:
                collider.find(V, F, [0, 1])
            except farcull.Error as error:
                os._exit(0 if error.where == "Collider" else 3)
            os._exit(4)
        except BaseException as error:
            print(error)
            os._exit(5)
    assert os.waitpid(child, 0)[1] == 0
    assert collider.find(V, F, [0, 1]).pairs.tolist() == [[0, 1]]
    """)


def test_without_memory_it_says_so():
    # 10^8 triangles with 1 GB left. The arrays take no memory: every row is the same one.
    out = python("""
    import resource
    import farcull
    import numpy as np
    with open("/proc/self/statm") as file:
        limit = (1 << 30) + int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    V = np.eye(3)
    F = np.broadcast_to(np.array([0, 1, 2], np.uint32), (10**8, 3))
    for call in (
        lambda: farcull.collide(V, F, self=True, threads=1),
        lambda: farcull.distances(V, F, [0, 5]),
        lambda: farcull.Scene.from_arrays(V, F),
        lambda: farcull.collide(np.broadcast_to(0.0, (10**9, 3)), F, self=True),
    ):
        try:
            call()
        except MemoryError:
            print("MemoryError")
    print(farcull.collide(V, [[0, 1, 2], [0, 0, 0]], [0, 1]).pairs.tolist())
    """)
    assert out == 4 * "MemoryError\n" + "[[0, 1]]\n"


def test_a_thousand_frames_leak_nothing():
    out = python("""
    import farcull, gc, resource
    import numpy as np

    def used():  # MB of memory now
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize() / 2**20

    rng = np.random.default_rng(5)
    V = rng.normal(size=(3000, 3)) * 3
    V[2::3] = V[::3] + rng.normal(size=(1000, 3)) * 0.1
    V[1::3] = V[::3] + rng.normal(size=(1000, 3)) * 0.1
    F = np.arange(3000).reshape(-1, 3)
    collider = farcull.Collider(self=True)
    at = {}
    for frame in range(1000):
        V += rng.normal(size=V.shape) * 0.001
        pairs = collider.find(V, F).pairs
        try:
            collider.find(V, -F - 1)
        except farcull.InputError:
            pass
        if frame % 10 == 0:
            farcull.collide(V, F.astype(np.int32)[::-1], [0, 500])
            scene = farcull.Scene.from_arrays(V, F, self=True)
            record = scene.run(threads=1)
            view = record.bits, scene.vertices, record.missed(), record.json()
        if frame in (199, 999):
            gc.collect()
            at[frame] = used()
    print(at[199], at[999])
    """)
    before, after = map(float, out.split())
    print(f"{before:.1f} MB after 200 frames, {after:.1f} MB after 1000")
    # A frame that is kept, 1000 of them 72 kB each, would be 58 MB more.
    assert after - before < 8, (before, after)


# Mesa's llvmpipe has no threads where farcull was imported first. The twin: another user of EGL has
# opened a display before, with two threads.
@pytest.mark.parametrize("threads", [0, 2])
def test_threads_of_llvmpipe_are_named(threads):
    earlier = f"""
    import ctypes, os
    os.environ["LP_NUM_THREADS"] = "{threads}"
    egl = ctypes.CDLL("libEGL.so.1")
    for name in ["eglGetPlatformDisplay", "eglCreateContext"]:
        getattr(egl, name).restype = ctypes.c_void_p
    surfaceless, opengl = 0x31DD, 0x30A2
    display = ctypes.c_void_p(egl.eglGetPlatformDisplay(surfaceless, None, None))
    assert egl.eglInitialize(display, None, None) and egl.eglBindAPI(opengl)
    assert egl.eglCreateContext(display, None, None, None)
    del os.environ["LP_NUM_THREADS"]
    """
    out = python(earlier + """
    import farcull
    assert os.environ["LP_NUM_THREADS"] == "0"
    device = farcull.Scene("two-spheres").run("cullide", resolution=64, device="software").json()["device"]
    print(device["renderer"], device["threads"], sep="|")
    """, env={**os.environ, "XDG_CACHE_HOME": os.path.dirname(os.environ["FARCULL_PROGRAM"]) + "/test-cache"})  # as other tests
    device, found = out.strip().split("|")
    if "llvmpipe" not in device:
        pytest.skip(f"the device is {device}")
    assert found == str(threads)
