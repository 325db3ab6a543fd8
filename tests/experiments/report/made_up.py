"""Chapters of rows that were made up: they go into a store and are read from there, as those of a report are."""
import importlib
import json
import pathlib
import sqlite3
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "experiments/report"))

from frame import Chapter, fill  # noqa: E402
from store import AXES, Store  # noqa: E402

TEXTS = [axis for axis in AXES if axis not in ("resolution", "frame", "seed")]
CONSTANTS = {"scene_resolution": 512, "few_triangles": 1000, "depth_rounding": {"24": 3.5, "32": 1.5},
             "scenes": {"needles": {"needs_meshes": False, "seed": 2}, "crowd": {"needs_meshes": False, "seed": 4},
                        "two-spheres": {"needs_meshes": False}, "cloth": {"needs_meshes": False},
                        "two-bunnies": {"needs_meshes": True}}}


def row(scene, method, counts=(), ms=2.0, left_out="", runs=None, void=(), **axes):
    """A row of a study: its point, counts and times. Counts of None are not there. runs: in three rounds of the same
    length, those in `void` void."""
    times = {} if ms is None else {"total": ms}
    if runs:
        each = -(-len(runs) // 3)
        times["rounds"] = [{"ms": list(runs[i * each:(i + 1) * each]), "load": 0.01, "void": i in void}
                           for i in range(3)]
    point = {**dict.fromkeys(TEXTS, ""), "resolution": 0, "frame": -1, "seed": 0, "scene": scene, "method": method}
    if method == "far":
        point |= {"offset": "obb", "radius": "budget"}
    return {**point, **axes}, {k: v for k, v in dict(counts).items() if v is not None}, times, left_out


def run_counts(missed=0, promises=False, **more):
    """Counts of a run on a scene of 20 colliding pairs."""
    return {"colliding": 20, "missed": missed, "missed_penetrating": missed, "colliding_triangles": 10,
            "candidates": 40, "kept_triangles": 30, "triangles": 100, "promises": promises, "radius_px": 0.71,
            "pixel_size": 0.5, "left_by_boxes": 80, "views_used": 3, **more}


def study_of(name, rows, declared=0):
    """The Study of these rows; `declared`: how many points its grid has, if more than there are rows."""
    with tempfile.TemporaryDirectory() as folder:
        database = sqlite3.connect(folder + "/results.sqlite")
        axes = ", ".join(f'"{axis}"' for axis in AXES)
        database.executescript(
            "CREATE TABLE runs (run, gl_renderer, commit_id, options); CREATE TABLE studies (study, quick, seed);"
            f"CREATE TABLE points (study, position, {axes});"
            "CREATE TABLE rows (study, position, run, measured, device, counts, times, left_out);")
        database.execute("INSERT INTO studies VALUES (?, 0, 1)", [name])
        for at in range(max(len(rows), declared)):
            point = rows[min(at, len(rows) - 1)][0] if rows else row("s", "exact")[0]
            database.execute(f"INSERT INTO points VALUES (?, ?{', ?' * len(AXES)})",
                             [name, at] + [point[axis] for axis in AXES])
        for at, (_, counts, times, left_out) in enumerate(rows):
            database.execute("INSERT INTO rows VALUES (?, ?, 1, '', '', ?, ?, ?)",
                             [name, at, json.dumps(counts), json.dumps(times), left_out])
        database.commit()
        database.close()
        return Store(folder).study(name, CONSTANTS)


def chapter_of(name, rows, declared=0):
    """The chapter as the report has it: broken findings first."""
    chapter = Chapter(name, "title", "question?", "command")
    fill(chapter, study_of(name, rows, declared))
    chapter.findings.sort(key=lambda finding: not finding[0])
    return chapter


def findings(chapter):
    """All sentences, a line each, as the report prints them."""
    return "\n".join(("BROKEN: " if broken else "") + text for broken, text in chapter.findings)


def table(chapter, name):
    """The rows of a table."""
    return next(table for table in chapter.tables if table.name == name).rows


def figure(chapter, name):
    """A figure, or None."""
    return next((figure for figure in chapter.figures if figure.name == name), None)
