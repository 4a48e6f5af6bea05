/// bench_engine: crashsim's own engines on the workloads, and how their time grows. `--benchmark_filter='^W1'` chooses.

#include <iostream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "json_lines.hpp"

namespace crashsim::bench {

void JsonLines::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.error_occurred) throw std::runtime_error(run.benchmark_name() + ": " + run.error_message);
    if (run.repetitions > 1 && run.aggregate_name != "median") continue;
    const std::string& name = run.run_name.function_name;
    const std::size_t bar = name.find('|');
    const auto items = run.counters.find("items");
    const double unit =
        benchmark::GetTimeUnitMultiplier(run.time_unit) * (items == run.counters.end() ? 1.0 : items->second.value);
    nlohmann::json line = {{"workload", name.substr(0, bar)},
                           {"engine", name.substr(bar + 1)},
                           {"sundials", CRASHSIM_SUNDIALS},
                           {"seconds", run.GetAdjustedCPUTime() / unit},
                           {"wall", run.GetAdjustedRealTime() / unit}};
    for (const auto& [counter, value] : run.counters) line[counter] = value.value;
    std::cout << line << std::endl;  // at once: a long run shows what it has
  }
}

}  // namespace crashsim::bench

int main(int argc, char** argv) {
  using namespace crashsim::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    register_forward();
    register_fit();
    register_pitch();
    register_many();
    register_scaling();
    JsonLines reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
  } catch (const std::exception& error) {
    std::cerr << "bench_engine: " << error.what() << '\n';
    return 1;
  }
}
