/// rviz's part in `forget`.
#pragma once

#include <functional>
#include <memory>
#include <string>

#ifndef Q_MOC_RUN
#include <rviz/display_context.h>
#endif

namespace tensegric_fit::inspect {

/// Panels and displays let go of a scan when the vault orders it; when all of this rviz have, the vault has
/// one answer. rviz's own displays, which do not know of what scan they show something, are all reset: one of
/// points or markers stays empty until something comes again. What comes of the scan later is for
/// node::is_of_forgotten. For the thread in which rviz calls its subscribers.
class Forgetting {
 public:
  /// False: nothing of that scan was held.
  using LetGo = std::function<bool(const std::string& scan_id)>;

  Forgetting(rviz::DisplayContext& rviz, LetGo let_go);
  ~Forgetting();
  Forgetting(const Forgetting&) = delete;
  Forgetting& operator=(const Forgetting&) = delete;

 private:
  class Desk;

  rviz::DisplayContext& rviz_;
  const LetGo let_go_;
  const std::shared_ptr<Desk> desk_;  // of all
};

}  // namespace tensegric_fit::inspect
