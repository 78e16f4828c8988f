// What jemalloc does otherwise than by default in the programs of stages; it reads this when it starts.
#include <jemalloc/jemalloc.h>

// While a stage works nothing goes back to the system, since it would be taken again at once; at rest all of
// it does (freed_memory.hpp). Of a scan through the chain this takes 2 % more time than glibc's allocator,
// jemalloc's defaults 8 % (tests/soak/README.md).
const char* malloc_conf = "dirty_decay_ms:-1,oversize_threshold:0";
