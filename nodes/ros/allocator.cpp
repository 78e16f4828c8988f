// What jemalloc does otherwise than by default in nodes; it reads this when it starts.
#include <jemalloc/jemalloc.h>

// While a node works little goes back to the system, since it would be taken again at once (dirty_decay_ms);
// at rest it does (freed_memory.hpp). Pieces that no scan needs, as of a message that lies about its size, go
// back when they are freed (oversize_threshold: 128 MB). What goes back is unmapped (retain): it would still
// count for limit_memory.
const char* malloc_conf = "dirty_decay_ms:60000,oversize_threshold:134217728,retain:false";
