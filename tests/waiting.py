"""Waiting for what a test expects of other processes."""

import os
import time
from collections.abc import Callable
from typing import TypeVar

# Seconds; with the validation layer kernels take long to compile.
PATIENCE = 600 if os.environ.get("VKPM_VALIDATION") else 120
Found = TypeVar("Found")


def eventually(what: str, look: Callable[[], Found], patience: float = PATIENCE) -> Found:
    """Waits until a look finds something, for some seconds at most, and returns it."""
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        if found := look():
            return found
        time.sleep(0.02)
    raise AssertionError(f"waited in vain for {what}")
