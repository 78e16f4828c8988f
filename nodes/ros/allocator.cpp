// What jemalloc does otherwise than by default in nodes; it reads this when it starts.
#include <jemalloc/jemalloc.h>

// While a node works nothing goes back to the system, since it would be taken again at once (dirty_decay_ms;
// a finite decay gave most back at once where memory is unmapped); at rest it does (freed_memory.hpp), pieces
// of any size alike (oversize_threshold). What goes back is unmapped (retain): it would still count for
// limit_memory.
const char* malloc_conf = "dirty_decay_ms:-1,oversize_threshold:0,retain:false";
