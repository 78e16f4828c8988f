#include "ros/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace tensegric_fit::node {

void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take terabytes of address space
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return;
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const rlim_t half = static_cast<rlim_t>(pages) * static_cast<rlim_t>(page) / 2;
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > half) {
    limit.rlim_cur = half;
    setrlimit(RLIMIT_DATA, &limit);
  }
#endif
}

}  // namespace tensegric_fit::node
