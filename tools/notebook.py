#!/usr/bin/env python3
"""Runs a notebook of docs/notebooks in the folder of the sources, and keeps what it printed and drew:

    tools/notebook.py FILE.ipynb           writes it back
    tools/notebook.py FILE.ipynb --check   tells whether it runs and prints the same; pictures may differ

PYTHONPATH has the package hvas.
"""

import os
import pathlib
import sys

import nbformat
from nbclient import NotebookClient

os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # The kernel warns of a debugger that nobody uses.
ROOT = pathlib.Path(__file__).resolve().parent.parent


def texts(notebook):
    """What each cell printed."""
    return ["".join(output.get("text", "") for output in cell.get("outputs", [])) for cell in notebook.cells if cell.cell_type == "code"]


def pictures(notebook):
    return sum("image/png" in output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", []))


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    file = pathlib.Path(sys.argv[1])
    notebook = nbformat.read(file, as_version=4)
    before = texts(notebook)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(ROOT)}}).execute()
    if len(sys.argv) == 3:
        for stored, printed in zip(before, texts(notebook), strict=True):
            if stored != printed:
                print(f"{file}: a cell printed\n{printed}and has\n{stored}")
                return 1
        print(f"{file}: {len(before)} cells run, {pictures(notebook)} pictures")
        return 0 if pictures(notebook) else 1
    for cell in notebook.cells:
        cell.get("metadata", {}).pop("execution", None)  # Times of this run.
    notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    nbformat.write(notebook, file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
