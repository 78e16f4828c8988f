/// A batch: the jobs of one shard through the chain, what is missing only.
#pragma once

#include <string>

#include "batch/worker_pool.hpp"

namespace tensegric_fit::batch {

struct BatchOptions {
  std::string manifest, out;
  std::size_t shard = 1, shards = 1;  ///< rows whose number leaves shard - 1 when divided by shards
  int workers = 1;
  WorkerLimits limits;
  bool retry = false;  ///< also what crashed, took too long or too much memory before
  bool quiet = false;
};

/// Exit code: 0 every row of the shard has its line (refusals are lines), 1 a file cannot be written, 3 the
/// manifest is refused, 130 it was interrupted, or one of its workers, whose row has no line.
int run_batch(const BatchOptions& options);

/// The name of a shard's file of results.
std::string shard_name(std::size_t shard, std::size_t shards);

}  // namespace tensegric_fit::batch
