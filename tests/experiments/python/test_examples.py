"""The examples of docs/example/python run, and say what their pages say. So does the README."""
import contextlib
import io
import json
import os
import pathlib
import re

import numpy as np
import pytest

ROOT = pathlib.Path(os.environ["FARCULL_ROOT"])
EXAMPLES = ROOT / "docs" / "example" / "python"


def printed(code, names):
    """What the code prints that is run with these names."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(code, names)
    return out.getvalue()


@pytest.mark.parametrize("name, pattern", [
    ("pairs", "".join(f"triangle 2 of the first and triangle {k} of the second\n" for k in (0, 1, 3))),
    ("cloth", r"since frame 26: 3 pairs, around( -?\d+\.\d+){3}\n"),
    ("lemma", "no pair was culled\nwith a hundredth of the radius, far missed the triangles(?s:.*)")])
def test_an_example_prints_this(name, pattern):
    out = printed((EXAMPLES / f"{name}.py").read_text(), {"__name__": "__main__"})
    assert re.fullmatch(pattern, out), out


def cells():
    notebook = json.loads((EXAMPLES / "farcull.ipynb").read_text())
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run_cells(all_cells):
    """The number of the first cell that does not print what the notebook holds, or None."""
    names = {"__name__": "notebook"}
    for number, cell in enumerate(all_cells):
        out = printed("".join(cell["source"]), names)
        if out != "".join("".join(output.get("text", "")) for output in cell["outputs"]):
            return number, out
    return None


def test_the_notebook_holds_what_its_cells_print():
    assert len(cells()) >= 4
    assert run_cells(cells()) is None
    changed = cells()  # the twin
    changed[2]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["nothing\n"]}]
    assert run_cells(changed)[0] == 2


def test_the_lines_of_the_readme():
    text = (ROOT / "README.md").read_text()
    blocks = re.findall(r"(?:^    .*\n)+", text, re.MULTILINE)
    lines = [block for block in blocks if "import farcull" in block]
    assert len(lines) == 1 and len(lines[0].splitlines()) == 3
    V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]], float)
    names = {"V": V, "F": np.array([[0, 1, 2]] * 12 + [[3, 4, 5]])}
    assert "[ 0 12]" in printed("".join(line[4:] + "\n" for line in lines[0].splitlines()), names)


def test_the_code_of_the_page_runs():
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.DOTALL)
    assert len(blocks) >= 2
    for block in blocks:
        printed(block, {})
