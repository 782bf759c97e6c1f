"""A table on disk that a sweep fills: replaced as a whole each time, so that it is never half written."""

import csv
import os
from pathlib import Path
from tempfile import NamedTemporaryFile

from primer.checks import shown


class Table:
    """Rows of numbers by key, in a CSV file, or in memory only with path None.

    path       the file; where it exists its rows are there already
    settings   what all rows have in common, kept in the first line as ``name=value``
    keys       names of the columns that make up a row's key
    values     names of the others

    Raises
    ------
    ValueError    if the file is of other settings or columns, or is not such a table, or cannot be written
    TypeError     if path is no path
    """

    def __init__(self, path, settings, keys, values):
        self.path, self.rows, self._keys = (None if path is None else _usable(path)), {}, len(keys)
        self._head = "# " + " ".join(f"{name}={value!r}" for name, value in settings.items())
        self._names = [*keys, *values]
        if self.path is not None and self.path.exists():
            self._read()

    def _read(self):
        with self.path.open(newline="", encoding="utf-8") as file:
            head, rows = file.readline().rstrip("\r\n"), csv.reader(file)
            if head != self._head or next(rows, None) != self._names:
                raise ValueError(
                    f"table must be new or one of the same sweep ({self._head[2:]}), got {shown(str(self.path))}"
                )
            for row in rows:
                numbers = [float(cell) for cell in row]
                self.rows[tuple(numbers[: self._keys])] = tuple(numbers[self._keys :])

    def add(self, rows):
        """Add rows, a mapping from keys to values, and save."""
        self.rows.update({tuple(map(float, key)): tuple(map(float, value)) for key, value in rows.items()})
        if self.path is None:
            return
        with NamedTemporaryFile(
            "w", dir=self.path.parent, prefix=f".{self.path.name}-", newline="", encoding="utf-8", delete=False
        ) as file:
            try:
                file.write(self._head + "\n")
                csv.writer(file, lineterminator="\n").writerows(
                    [self._names, *([repr(x) for x in (*key, *value)] for key, value in sorted(self.rows.items()))]
                )
            except BaseException:
                os.unlink(file.name)
                raise
        os.replace(file.name, self.path)


def _usable(path):
    """The path, or one sentence that says why no file can be kept there: before the sweep, not after its first hour."""
    if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str):
        raise TypeError(f"table must be the path of a CSV file or None, got {shown(path)}")
    if not path or Path(path).is_dir():
        raise ValueError(f"table must be the path of a CSV file, got the folder {shown(str(path))}")
    path = Path(path)
    try:
        with NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}-"):
            return path
    except OSError as error:
        raise ValueError(
            f"table must be a file in a folder that can be written, got {shown(str(path))} ({error.strerror})"
        ) from None
