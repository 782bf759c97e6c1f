"""What each notebook asks of a reader: ``python tests/course_table.py`` prints minutes, lines, comprehensions, width.

Minutes are words/200 + 1.5 a code cell; code lines leave out blank ones, imports and the student's own program.
"""

import ast
import re
from pathlib import Path

import nbformat

COURSE = Path(__file__).parents[1] / "notebooks"
LOOPS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


def measured(path):
    """(minutes, code lines, comprehensions, longest line) of a notebook."""
    cells = nbformat.read(path, as_version=4).cells
    words = sum(len(cell.source.split()) for cell in cells if cell.cell_type == "markdown")
    code = [cell.source for cell in cells if cell.cell_type == "code"]
    ours = [cell.source for cell in cells if cell.cell_type == "code" and "yours" not in cell.metadata.get("tags", ())]
    lines = [line for source in ours for line in source.splitlines() if line.strip()]
    loops = sum(isinstance(node, LOOPS) for source in ours for node in ast.walk(ast.parse(source)))
    counted = [line for line in lines if not re.match(r"(from|import) ", line)]
    return round(words / 200 + 1.5 * len(code)), len(counted), loops, max(map(len, lines))


if __name__ == "__main__":
    print("| notebook | minutes | code lines | comprehensions | longest line |\n|---|---:|---:|---:|---:|")
    for lesson in sorted(COURSE.glob("*.ipynb")):
        print(f"| {lesson.stem} | " + " | ".join(map(str, measured(lesson))) + " |")
