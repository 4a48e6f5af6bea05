"""Batches on Dask, Ray and MPI: the bytes of own processes, also when a worker is killed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import crashsim
import support
from batch_support import Killer, children_of, command_of, files_of, write_cases

COUNT = 16


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with cases in in/, and in own/ what own processes make of them."""
    folder = tmp_path_factory.mktemp("engines")
    write_cases(folder / "in", COUNT)
    before = os.getcwd()
    os.chdir(folder)
    crashsim.run_batch("in/*.toml", "own")
    os.chdir(before)
    return folder


@pytest.fixture(autouse=True)
def there(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(place)


def assert_complete(report: crashsim.BatchReport, out: Path) -> None:
    assert (report.done, report.failed) == (COUNT, 4), report
    assert files_of(out) == files_of(Path("own"))


@pytest.fixture(scope="module")
def dask_client() -> Iterator[Any]:
    """Two worker processes under nannies, which start another when one dies."""
    distributed = pytest.importorskip("distributed", reason="needs Dask: pip install distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_dask_also_when_a_worker_is_killed(dask_client: Any, tmp_path: Path) -> None:
    whole = crashsim.run_batch("in/*.toml", tmp_path / "whole", executor=dask_client.get_executor())
    assert_complete(whole, tmp_path / "whole")
    killer = Killer(lambda: dask_client.run(os.getpid).values())
    report = crashsim.run_batch("in/*.toml", tmp_path / "out", executor=dask_client, progress=killer)
    assert_complete(report, tmp_path / "out")
    assert killer.killed


def test_ray_also_when_a_worker_is_killed(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ray = pytest.importorskip("ray", reason="needs Ray: pip install ray")
        ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:

        def workers() -> list[int]:
            daemons = [pid for pid in children_of(os.getpid()) if b"raylet" in command_of(pid)]
            return [pid for daemon in daemons for pid in children_of(daemon) if b"_call" in command_of(pid)]

        killer = Killer(workers)
        with crashsim.RayExecutor() as executor:
            report = crashsim.run_batch("in/*.toml", tmp_path / "out", executor=executor, progress=killer)
        assert_complete(report, tmp_path / "out")
        assert killer.killed
    finally:
        ray.shutdown()


def test_mpi_with_two_ranks(tmp_path: Path) -> None:
    pytest.importorskip("mpi4py", reason="needs mpi4py: pip install mpi4py, and an MPI")
    if shutil.which("mpiexec") is None:
        pytest.skip("needs mpiexec: apt install openmpi-bin")
    command = ["mpiexec", "-n", "2", sys.executable, "-m", "mpi4py.futures"]
    command += [str(support.ROOT / "docs/mpi-batch.py"), "in/*.toml", str(tmp_path / "out")]
    environment = {
        **os.environ,
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PYTHONPATH": os.pathsep.join(sys.path),
    }
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, env=environment)
    assert (done.stdout, done.returncode) == ("16 of 16 cases done, 4 failed\n", 3), done.stderr
    assert files_of(tmp_path / "out") == files_of(Path("own"))
