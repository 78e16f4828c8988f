/// The numbers by which a recorded fit is judged.
#pragma once

#include <map>
#include <string>

namespace tensegric_fit::tests {

/// From a bag that replay.launch has written, for its only scan: height/NAME, girth/NAME, landmark/NAME/x|y|z
/// (scan frame), line/NAME/ratio, region/NAME/volume_error, body/triangles, body/volume, body/volume_change
/// (share), body/largest_move, distortion/least, distortion/most, fit/converged. Metres, m^3. \throw
/// std::runtime_error: a topic is missing or comes twice, or two scan_ids are in the bag
std::map<std::string, double> fit_metrics(const std::string& bag);

}  // namespace tensegric_fit::tests
