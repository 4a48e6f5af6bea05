#!/usr/bin/env bash
#SBATCH --job-name=crashsim
#SBATCH --ntasks=65
#SBATCH --time=02:00:00
#SBATCH --requeue
# A batch on the ranks of one MPI job: sbatch mpi-batch.sh cases.txt results
# A job that is stopped or requeued goes on where it was.
set -euo pipefail

manifest=${1:?usage: sbatch mpi-batch.sh MANIFEST FOLDER}
folder=${2:?usage: sbatch mpi-batch.sh MANIFEST FOLDER}

exec mpiexec -n "${SLURM_NTASKS:?is set by sbatch --ntasks}" python -m mpi4py.futures mpi-batch.py "$manifest" "$folder"
