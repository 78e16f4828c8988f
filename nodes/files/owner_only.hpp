/// Files that only their owner may read.
#pragma once

namespace tensegric_fit::files {

/// From now on what this process creates is its owner's only: files 0600, folders 0700. For main functions,
/// before anything is written, a log included.
void owner_only();

}  // namespace tensegric_fit::files
