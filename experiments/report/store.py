"""Reads a store of results (experiments/studies/store.h) into data frames.

`farcull report` has opened the store before. It refuses a store that is damaged or of another version.
"""
import json
import pathlib
import sqlite3
import urllib.parse

import pandas as pd

from frame import Study, contestant

ROUNDS = 3  # number of rounds of a timed point; equals kRounds of experiments/studies/point.h
AXES = ["scene", "method", "offset", "radius", "depth_format", "depth_mode", "resolution", "views", "frame", "seed"]


class Store:
    def __init__(self, folder):
        self.folder, self.path = folder, f"{folder}/results.sqlite"
        name = urllib.parse.quote(str(pathlib.Path(self.path).absolute()))
        # Opened for writing, so that SQLite can first roll back the unfinished transaction of a killed program.
        self.database = sqlite3.connect(f"file:{name}?mode=rw", uri=True)
        self.runs = self.read("SELECT * FROM runs ORDER BY run")
        self.names = list(self.read("SELECT study FROM studies ORDER BY rowid").study)

    def read(self, question, *parameters):
        return pd.read_sql_query(question, self.database, params=parameters)

    @property
    def device(self):
        return self.runs.gl_renderer.iloc[-1] if len(self.runs) else "no device"

    @property
    def commit(self):
        return self.runs.commit_id.iloc[-1] if len(self.runs) else ""

    def study(self, name, constants):
        declared = self.read("SELECT * FROM studies WHERE study = ?", name).iloc[0]
        points = self.read("SELECT * FROM points WHERE study = ? ORDER BY position", name)
        rows = self.read("SELECT position, run, measured, device, counts, times, left_out, points.* FROM rows JOIN "
                         "points USING (study, position) WHERE study = ? ORDER BY position", name)
        rows = rows.loc[:, ~rows.columns.duplicated()].drop(columns="study")
        counts, times = ([json.loads(text) for text in texts] for texts in (rows.counts, rows.times))
        rows["counts"], rows["times"] = counts, times
        # A round is void if other programs used the processors. A void round becomes (), so later rounds keep their index.
        rounds = [t.get("rounds", []) for t in times]
        rows["rounds"] = [tuple(() if r["void"] else tuple(r["ms"]) for r in of) for of in rounds]
        rows["runs"] = [sum(of, ()) for of in rows.rounds]
        rows["void"] = [sum(r["void"] for r in of) for of in rounds]
        rows["untimed"] = [t.get("no_times", False) for t in times]
        rows["whole"] = ["rounds" not in t or len(t["rounds"]) >= ROUNDS or t.get("no_times", False) for t in times]
        values = [{**{n + "_count" if n in AXES else n: v for n, v in c.items()},
                   **{n + "_ms": v for n, v in t.items() if n not in ("rounds", "no_times")}} for c, t in zip(counts, times)]
        rows = pd.concat([rows, pd.DataFrame(values, rows.index)], axis=1)
        rows["contestant"] = [contestant(row) for row in rows.itertuples()]
        return Study(name, bool(declared.quick), int(declared.seed), points, rows, constants, self.folder)


def other_devices(folder, first):
    """Returns the stores of further devices in the folder, sorted by name, and notes about stores that were left out because they
    are of another commit."""
    stores, notes = [], []
    for path in sorted(pathlib.Path(folder).glob("on-*/results.sqlite")):
        other = Store(f"{folder}/{path.parent.name}")
        if other.commit == first.commit:
            stores.append(other)
        else:
            notes.append(f"{folder}/{path.parent.name} is of another commit, and is not compared")
    return stores, notes
