/// What each stage takes, beside a fixed piece of work in the same process.
#pragma once

#include <string>
#include <vector>

namespace tensegric_fit::benchmarks {

/// Medians of several rounds.
struct StageCost {
  std::string stage;
  double kernels = 0;  ///< its time, in times of the calibration kernel right before it
  double spread = 0;   ///< of that, most / least
  double milliseconds = 0;
  double mebibytes = 0;  ///< by which the process grows at most
};

/// The five stages for a scan of the virtual booth worn with B1, in their order, the registration of the body
/// model to a mesh, and the change of a garment. Each round runs them all. Their names are the keys of
/// speed_baseline.yaml.
std::vector<StageCost> stage_costs(int rounds);

}  // namespace tensegric_fit::benchmarks
