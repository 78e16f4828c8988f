/// Memory that was freed, back to the system.
#pragma once

namespace tensegric_fit::node {

/// All that this process has freed, but for a few small pieces that each thread keeps. With jemalloc, which
/// stage nodes are linked with: glibc's `malloc_trim`, which other programs use, leaves the free end of every
/// arena but the main one, up to 16 MB each.
void give_back_freed_memory();

}  // namespace tensegric_fit::node
