#include "ros/warning_messages.hpp"

#include "inspect/warning_words.hpp"

namespace tensegric_fit::node {

FitWarnings to_message(const ScanTag& tag, const std::string& garment,
                       const std::vector<geometry::FitWarning>& warnings,
                       const geometry::BodyMeasures& measures) {
  FitWarnings message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.garment = garment;
  for (const geometry::FitWarning& warning : warnings) {
    FitWarning said;
    said.code = warning.code;
    said.message = inspect::words::warning(warning, measures);
    said.line = warning.line;
    said.lack = warning.lack;
    for (int axis = 0; axis < 3; ++axis) {
      said.place[axis] = warning.at_rest[axis];
      said.place_worn[axis] = warning.worn[axis];
    }
    said.area = warning.area;
    said.shelf_area = warning.shelf_area;
    said.value = warning.value;
    said.vertices.assign(warning.vertices.begin(), warning.vertices.end());
    (warning.is_warning() ? message.warnings : message.notices).push_back(std::move(said));
  }
  return message;
}

}  // namespace tensegric_fit::node
