"""Tasks on a dask cluster.

Not through joblib's backend for dask, which waits for good once a worker died with a result that nobody had
fetched yet. dask itself says which task no worker survives.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any


def completed(
    call: Callable[[int], tuple[Any, Any, Any]], order: Sequence[int], jobs: int
) -> Iterator[tuple[int, Any, Exception | None]]:
    """Carry tasks out on the present client's cluster, `jobs` at a time.

    Args:
        call: Function, arguments and keyword arguments of a task, by its number.
        order: Of the tasks.
        jobs: How many at a time.

    Yields:
        Number and result of each task as it is done; the error in its place if its worker died.
    """
    distributed: Any = importlib.import_module("distributed")
    client, done = distributed.get_client(), distributed.as_completed()
    numbers: dict[Any, int] = {}
    waiting = iter(order)

    def submit_next() -> None:
        for i in waiting:
            function, args, options = call(i)
            future = client.submit(function, *args, **options, pure=False)
            numbers[future] = i
            done.add(future)
            return

    for _ in range(jobs):
        submit_next()
    for future in done:
        i = numbers.pop(future)
        try:
            yield i, future.result(), None
        except Exception as error:
            yield i, None, error
        submit_next()
