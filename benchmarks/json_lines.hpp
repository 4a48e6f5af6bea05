#pragma once
/// Results of Google Benchmark as one JSON object a line, as all programs of script/bench write them:
///     {"workload": "W1", "engine": "...", "seconds": ..., "wall": ..., <counters>}

#include <benchmark/benchmark.h>

namespace crashsim::bench {

/// Writes the medians of the repetitions to the standard output. A benchmark's name is `workload|engine`; counters
/// become members.
class JsonLines : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;
};

/// Registers `work(state)`, timed by the CPU time of the whole process.
template <class Work>
benchmark::internal::Benchmark* measure(const std::string& workload, const std::string& engine, Work work) {
  return benchmark::RegisterBenchmark((workload + "|" + engine).c_str(), work)->MeasureProcessCPUTime();
}

// What each file measures.
void register_forward();
void register_fit();
void register_pitch();
void register_many();
void register_scaling();

}  // namespace crashsim::bench
