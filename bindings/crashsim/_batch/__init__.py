"""Batches of cases on the engines that people have: what this needs beside the extension is Python's own library."""

from .executors import RayExecutor
from .run import run_batch

__all__ = ["RayExecutor", "run_batch"]
