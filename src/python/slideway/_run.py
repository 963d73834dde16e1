"""Long work beside the calling thread, so that Ctrl-C, a time limit and progress reach it."""

from __future__ import annotations

import atexit
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from queue import Empty, SimpleQueue
from typing import TypeVar

from slideway._slideway import Cancellation

Result = TypeVar("Result")
Progress = Callable[[str, float], object]

_POLL_S = 0.05
_GRACE_S = 5.0
_workers: set[threading.Thread] = set()


def run(
    work: Callable[[Progress, Cancellation], Result],
    what: str,
    progress: Progress | None,
    timeout: float | None,
) -> Result:
    """Does the work in a thread of its own; what it tells reaches ``progress`` in this thread.

    Work that is left, by an exception here, ends when it next tells its progress or calls an effect
    of the user's.

    :raises TimeoutError: not done after so many seconds
    """
    told: SimpleQueue[tuple[str, float]] = SimpleQueue()
    cancellation = Cancellation()
    future: Future[Result] = Future()

    def tell(stage: str, done: float) -> None:
        told.put((stage, done))

    def target() -> None:
        try:
            future.set_result(work(tell, cancellation))
        except BaseException as error:
            future.set_exception(error)
        finally:
            _workers.discard(threading.current_thread())

    def pass_on() -> None:
        try:
            while progress is not None:
                progress(*told.get_nowait())
        except Empty:
            pass

    end = None if timeout is None else time.monotonic() + timeout
    worker = threading.Thread(target=target, name="slideway", daemon=True)
    _workers.add(worker)
    worker.start()
    try:
        while not wait([future], _POLL_S).done:
            pass_on()
            if end is not None and time.monotonic() > end:
                raise TimeoutError(f"{what}: not done after {timeout:g} s")
        pass_on()
    finally:
        cancellation.cancel()
    return future.result()


@atexit.register
def _let_workers_end() -> None:
    for worker in list(_workers):
        worker.join(_GRACE_S)
