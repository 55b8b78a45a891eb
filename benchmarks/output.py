"""Output folders that are either complete or untouched."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from estimators.errors import GtEnvError


class OutputError(GtEnvError, OSError):
    """An output folder or file that cannot be written."""


def check_writable(folder: Path) -> None:
    """Refuse an output folder before any work is done for it; it is not made yet.

    Raises:
        OutputError: If the folder cannot be made or written to.
    """
    absent = missing(folder)
    try:
        with tempfile.TemporaryFile(dir=absent[-1].parent if absent else folder):
            pass
    except OSError as error:
        raise OutputError(f"--out {folder}: cannot be written to: {error.strerror}") from None


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """A scratch folder whose files move to `folder` together when the block ends well, and vanish otherwise.

    Files of the same name are replaced, others stay.

    Raises:
        OutputError: If writing fails, e.g. because the disk is full.
    """
    check_writable(folder)
    made = missing(folder)
    folder.mkdir(parents=True, exist_ok=True)
    scratch = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=folder))
    try:
        yield scratch
        for path in sorted(scratch.rglob("*")):
            place = folder / path.relative_to(scratch)
            if path.is_dir():
                place.mkdir(exist_ok=True)
            else:
                os.replace(path, place)
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{folder}: nothing was written: {error.strerror}") from None
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        remove_empty(made)


def missing(folder: Path) -> list[Path]:
    """The folders that must be made to have this one, innermost first."""
    return [path for path in (folder, *folder.parents) if not os.path.lexists(path)]


def remove_empty(folders: Iterable[Path]) -> None:
    """Remove folders, innermost first, up to the first that holds something."""
    with suppress(OSError):
        for path in folders:
            path.rmdir()
