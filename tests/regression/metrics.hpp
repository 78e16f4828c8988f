/// The numbers and words by which a recording is judged.
#pragma once

#include <map>
#include <string>

#include "case.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {

using Metrics = std::map<std::string, Value>;

/// The larger of two differences; infinite where the second is not finite, which std::max would drop.
double worse(double so_far, double next);

/// Metres, cubic metres, radians, milliseconds, MiB. Names:
///   refusal, refused_by                        code and stage, or "none"
///   landmark/NAME/x|y|z                        scan frame
///   height/NAME, girth/NAME
///   body/triangles, body/volume, body/filled   filled: share of the vertices that no point supports
/// and, for each garment, after "N/" where there are several:
///   fit/status, fit/solver, fit/iterations, fit/residual
///   line/NAME/ratio, line/NAME/tension
///   region/NAME/volume, region/NAME/volume_error    volume at rest, and (after - before) / before
///   region/NAME/body_volume_error   the same of the body under it, in the fit's posture
///   body/volume_change                         share
///   body/largest_move
///   body/other_roundings    coordinates that are not the nearest single ones to the double result; in the
///                           posture of the scan
///   distortion/least|p05|median|p95|most
/// time/STAGE and memory/STAGE are of the run, not of its result.
Metrics metrics_of(const Recording& recording);

/// What is known of the errors of a recording of that customer. Names as above after "error/": heights and
/// girths with their sign, landmark/NAME the distance, body/volume as a share; error/surface/median|p95 is
/// how far the body mesh, where points support it, is from the true skin, and noise/median how far the scan's
/// points are from the body mesh. error/normals/median|p95: angle between the normals there, degrees;
/// error/normals/body/median|p95: without head, hands and feet.
Metrics errors_of(const Recording& recording, const Customer& customer);

}  // namespace tensegric_fit::regression
