"""The examples of docs/example/python run, and say what their pages say. So does the README."""

import ast
import contextlib
import io
import json
import os
import pathlib
import re
import runpy

import pytest

ROOT = pathlib.Path(os.environ["FARCULL_ROOT"])
EXAMPLES = ROOT / "docs" / "example" / "python"


def output_of(path):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        runpy.run_path(str(path), run_name="__main__")
    return out.getvalue()


def test_pairs():
    out = output_of(EXAMPLES / "pairs.py")
    assert out.splitlines() == [
        "triangle 2 of the first and triangle 0 of the second",
        "triangle 2 of the first and triangle 1 of the second",
        "triangle 2 of the first and triangle 3 of the second",
    ]


def test_cloth():
    out = output_of(EXAMPLES / "cloth.py")
    assert re.fullmatch(r"since frame 26: 3 pairs, around( -?\d+\.\d+){3}\n", out), out


def test_lemma():
    out = output_of(EXAMPLES / "lemma.py").splitlines()
    assert out[0] == "no pair was culled"
    assert out[1].startswith("with a hundredth of the radius, far missed the triangles")


def cells():
    notebook = json.loads((EXAMPLES / "farcull.ipynb").read_text())
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run_cells(all_cells):
    """The number of the first cell that does not print what the notebook holds, or None."""
    names = {"__name__": "notebook"}
    for number, cell in enumerate(all_cells):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(ast.parse("".join(cell["source"])), f"cell {number}", "exec"), names)
        if out.getvalue() != "".join("".join(output.get("text", "")) for output in cell["outputs"]):
            return number, out.getvalue()
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
    import numpy as np

    V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]], float)
    names = {"V": V, "F": np.array([[0, 1, 2]] * 12 + [[3, 4, 5]])}
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec("".join(line[4:] + "\n" for line in lines[0].splitlines()), names)
    assert "[ 0 12]" in out.getvalue()


@pytest.mark.parametrize("page", ["docs/python.md"])
def test_the_code_of_a_page_runs(page):
    text = (ROOT / page).read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 2
    for block in blocks:
        with contextlib.redirect_stdout(io.StringIO()):
            exec(block, {})
