"""A table on disk that a sweep fills: replaced as a whole each time, so that it is never half written."""

import csv
import os
from contextlib import contextmanager
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
        self.path = None if path is None else _usable(path)
        self.rows: dict[tuple, tuple] = {}
        self._keys = len(keys)
        self._head = "# " + " ".join(f"{name}={value!r}" for name, value in settings.items())
        self._names = [*keys, *values]
        if self.path is not None and self.path.exists():
            self._read(self.path)

    def _read(self, path):
        try:
            with path.open(newline="", encoding="utf-8") as file:
                head, (names, *rows) = file.readline().rstrip("\r\n"), csv.reader(file, strict=True)
            for row in rows:
                key, value = row[: self._keys], row[self._keys :]
                self.rows[tuple(map(float, key))] = tuple(map(float, value))
            sound = all(len(row) == len(self._names) for row in rows)
        except (OSError, ValueError, csv.Error):  # not text, not a table, not numbers
            sound = False
        if not sound or head != self._head or names != self._names:
            raise ValueError(
                f"table must be new or one of the same sweep ({self._head[2:]}), undamaged, got {str(path)!r}"
            )

    def add(self, rows):
        """Add rows, a mapping from keys to values, and save."""
        self.rows.update({tuple(map(float, key)): tuple(map(float, value)) for key, value in rows.items()})
        if self.path is None:
            return
        try:
            with written_whole(self.path) as file:
                file.write(self._head + "\n")
                csv.writer(file, lineterminator="\n").writerows(
                    [self._names, *([repr(x) for x in (*key, *value)] for key, value in sorted(self.rows.items()))]
                )
        except OSError as error:
            why = f"{error.strerror or error}; the table is as it was, and the same call goes on from there"
            raise OSError(error.errno, why, str(self.path)) from None


@contextmanager
def written_whole(path):
    """A text file to write that takes the place of ``path`` when all of it is on the disk; nothing is left if not."""
    path = Path(path)
    file = NamedTemporaryFile(  # noqa: SIM115  (closed, and so flushed, before it takes its place)
        "w", dir=path.parent, prefix=f".{path.name}-", newline="", encoding="utf-8", delete=False
    )
    try:
        with file:
            yield file
        os.replace(file.name, path)
    except BaseException:
        Path(file.name).unlink(missing_ok=True)
        raise


def _usable(path):
    """The path, or one sentence that says why no file can be kept there: before the sweep, not after its first hour."""
    if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str):
        raise TypeError(f"table must be the path of a CSV file or None, got {shown(path)}")
    if not path or Path(path).is_dir():
        raise ValueError(f"table must be the path of a CSV file, got the folder {str(path)!r}")
    path = Path(path)
    try:
        with NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}-"):
            return path
    except (OSError, ValueError) as error:
        raise ValueError(f"table must be in a folder that can be written, got {str(path)!r} ({error})") from None
