#!/usr/bin/env bash
#SBATCH --job-name=crashsim
#SBATCH --array=1-8
#SBATCH --cpus-per-task=16
#SBATCH --time=02:00:00
#SBATCH --requeue
# One shard of a batch for each job of the array: sbatch slurm-array.sh cases.txt results
# A job that is stopped or requeued goes on where it was. When all are done: crashsim merge results/shard* -o joined
set -euo pipefail

manifest=${1:?usage: sbatch slurm-array.sh MANIFEST FOLDER}
folder=${2:?usage: sbatch slurm-array.sh MANIFEST FOLDER}
shard=${SLURM_ARRAY_TASK_ID:?is set by sbatch --array}

mkdir -p "$folder"
exec crashsim batch "$manifest" -o "$folder/shard$shard" --shard "$shard/${SLURM_ARRAY_TASK_COUNT:?}" \
  --jobs "${SLURM_CPUS_PER_TASK:?}" --keep-going --resume --log-json "$folder/shard$shard.log"
