#pragma once
/// A loop over independent jobs on several threads.

#include <functional>

namespace crashsim {

/// Number of threads for an option `jobs`: itself, or all cores when 0.
int thread_count(int jobs);

/// Calls work(worker, index) for every index below `count`, each once, on `threads` threads (workers 0..threads-1).
/// Jobs are handed out in order. `progress(done, count)` runs on the calling thread now and then; when it returns false
/// no further job is started. The first exception of a job stops the loop and is thrown here.
/// @returns number of jobs finished.
int parallel_for(int count, int threads, const std::function<void(int worker, int index)>& work,
                 const std::function<bool(int done, int count)>& progress);

}  // namespace crashsim
