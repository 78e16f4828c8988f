/// Memory that a piece of work takes, as the kernel counts it.
#pragma once

#include <malloc.h>

#include <fstream>
#include <string>

namespace tensegric_fit::gauge {

/// A field of /proc/self/status, MiB; 0 where the kernel does not say.
inline double status_mebibytes(const std::string& field) {
  double kibibytes = 0;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == field + ":") status >> kibibytes;
  return kibibytes / 1024;
}

/// Starts the process's peak anew.
inline void forget_peak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// What the process grows by at most from now on.
class Growth {
 public:
  Growth() {
    malloc_trim(0);  // what was freed before would be taken again unseen
    forget_peak();
    start_ = status_mebibytes("VmRSS");
  }
  double mebibytes() const { return status_mebibytes("VmHWM") - start_; }

 private:
  double start_;
};

}  // namespace tensegric_fit::gauge
