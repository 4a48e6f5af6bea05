"""A batch on the ranks of an MPI job: mpiexec -n 65 python -m mpi4py.futures mpi-batch.py cases.txt results

Rank 0 hands out the cases, the others run them. Started again, it goes on where it was.
"""

import sys

from mpi4py.futures import MPIPoolExecutor

import crashsim

if __name__ == "__main__":
    manifest, folder = sys.argv[1:]
    with MPIPoolExecutor() as ranks:
        report = crashsim.run_batch(manifest, folder, executor=ranks, resume=True)
    print(f"{report.done} of {report.total} cases done, {report.failed} failed", flush=True)
    sys.exit(report.exit_code)
