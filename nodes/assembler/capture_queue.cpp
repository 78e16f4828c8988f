#include "assembler/capture_queue.hpp"

#include <utility>

namespace tensegric_fit::assembler {

std::shared_ptr<const CaptureTurn> CaptureQueue::put(Capture capture, std::string warning) {
  const int left_out = waiting_ ? waiting_->left_out + 1 : 0;
  return std::exchange(waiting_, std::make_shared<const CaptureTurn>(
                                     CaptureTurn{std::move(capture), std::move(warning), left_out}));
}

std::shared_ptr<const CaptureTurn> CaptureQueue::next() {
  if (!waiting_ || !at_work_.expired()) return nullptr;
  at_work_ = waiting_;
  return std::exchange(waiting_, nullptr);
}

}  // namespace tensegric_fit::assembler
