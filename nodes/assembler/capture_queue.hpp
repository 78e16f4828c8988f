/// Which capture is assembled next.
#pragma once

#include <memory>
#include <string>

#include "assembler/capture_join.hpp"

namespace tensegric_fit::assembler {

/// A capture that is to be assembled. Its turn lasts as long as anybody holds it.
struct CaptureTurn {
  Capture capture;
  std::string warning;  ///< of how it came
  int left_out;         ///< captures before it that had to make room
};

/// One capture at a time, to its end: of those that come meanwhile the newest waits. If newer ones took the
/// place of the one at work, sensors that send faster than it takes would never get a scan. For one thread,
/// but a turn may end in any.
class CaptureQueue {
 public:
  /// In place of any that waits, which is returned.
  std::shared_ptr<const CaptureTurn> put(Capture capture, std::string warning);

  /// Null where none waits, or the turn before lasts.
  std::shared_ptr<const CaptureTurn> next();

 private:
  std::shared_ptr<const CaptureTurn> waiting_;
  std::weak_ptr<const CaptureTurn> at_work_;
};

}  // namespace tensegric_fit::assembler
