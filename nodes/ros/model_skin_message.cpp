#include "ros/model_skin_message.hpp"

#include "geometry/status.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {

inspect::ModelSkin skin_in(const BodyModel& message) {
  inspect::ModelSkin skin{points_in(message.vertices), {}, message.skin_parts, message.parts};
  if (message.quads.size() % 4 != 0)
    throw geometry::Refusal(geometry::refusal::kBadModel,
                            "body model: the corners of its quadrilaterals do not come in fours");
  for (std::size_t i = 0; i < message.quads.size(); i += 4)
    skin.quads.push_back({static_cast<int>(message.quads[i]), static_cast<int>(message.quads[i + 1]),
                          static_cast<int>(message.quads[i + 2]), static_cast<int>(message.quads[i + 3])});
  inspect::check_model_skin(skin);
  return skin;
}

}  // namespace tensegric_fit::node
