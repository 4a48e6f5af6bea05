"""A batch on workers that Dask asks Slurm for: python dask-slurm.py cases.txt results

Runs on the login node or in a small job of its own; pip install dask-jobqueue. Started again, it goes on where it was.
"""

import sys

from dask.distributed import Client
from dask_jobqueue import SLURMCluster

import crashsim

if __name__ == "__main__":
    manifest, folder = sys.argv[1:]
    with SLURMCluster(cores=16, processes=16, memory="32GB", walltime="02:00:00") as cluster, Client(cluster) as client:
        cluster.adapt(maximum_jobs=8)  # 1 to 8 jobs of 16 workers, as there is work
        report = crashsim.run_batch(manifest, folder, executor=client, resume=True)
    print(f"{report.done} of {report.total} cases done, {report.failed} failed")
    sys.exit(report.exit_code)
