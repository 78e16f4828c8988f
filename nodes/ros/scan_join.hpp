/// Brings the messages of one scan together.
#pragma once

#include <boost/shared_ptr.hpp>

#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tensegric_fit::node {

/// Keeps the newest message of each topic. Each `Trigger` completes the join once, as soon as the newest
/// message of every other topic carries the same scan_id; messages of two scans never meet. Context that
/// comes again does not complete it again. For one thread.
template <typename Trigger, typename... Context>
class ScanJoin {
 public:
  using Joined = std::tuple<boost::shared_ptr<const Trigger>, boost::shared_ptr<const Context>...>;

  /// What the message completes, if anything.
  template <typename Message>
  std::optional<Joined> add(const boost::shared_ptr<const Message>& message) {
    if constexpr (std::is_same_v<Message, Trigger>)
      trigger_ = message;
    else
      std::get<boost::shared_ptr<const Message>>(context_) = message;
    if (!trigger_ || !(holds<Context>() && ...)) return std::nullopt;
    return std::tuple_cat(std::make_tuple(std::exchange(trigger_, nullptr)), context_);
  }

  /// The newest of a context, kept until the next; null where it was let go of.
  template <typename Message>
  boost::shared_ptr<const Message>& newest() {
    return std::get<boost::shared_ptr<const Message>>(context_);
  }

  /// The trigger that waits, if any: it will complete the join no more.
  boost::shared_ptr<const Trigger> give_up() { return std::exchange(trigger_, nullptr); }

 private:
  template <typename Message>
  bool holds() const {
    const auto& message = std::get<boost::shared_ptr<const Message>>(context_);
    return message && message->scan_id == trigger_->scan_id;
  }

  boost::shared_ptr<const Trigger> trigger_;
  std::tuple<boost::shared_ptr<const Context>...> context_;
};

}  // namespace tensegric_fit::node
