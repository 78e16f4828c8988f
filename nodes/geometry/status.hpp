/// Named refusals: how a stage rejects bad input.
#pragma once

#include <stdexcept>
#include <string>

namespace tensegric_fit::geometry {

/// Codes of the refusals, one per cause; `missing_part` is followed by ":<part>".
namespace refusal {
inline constexpr char kBrokenFile[] = "broken_file";         ///< truncated, unreadable, or of another format
inline constexpr char kWrongFields[] = "wrong_fields";       ///< no usable x, y, z
inline constexpr char kEmptyCloud[] = "empty_cloud";         ///< no points at all
inline constexpr char kNonFinite[] = "non_finite";           ///< no finite point, or NaN where none may be
inline constexpr char kTooFewPoints[] = "too_few_points";    ///< too sparse for the resolution needed
inline constexpr char kTooManyPoints[] = "too_many_points";  ///< more than memory is planned for
inline constexpr char kWrongUnit[] =
    "wrong_unit";  ///< the size of a body in no unit, or in two; of a message, not in metres
inline constexpr char kWrongAxes[] = "wrong_axes";      ///< a body that could stand on either of two ends
inline constexpr char kNotABody[] = "not_a_body";       ///< a shape, but not that of a standing person
inline constexpr char kMissingPart[] = "missing_part";  ///< missing_part:PART
inline constexpr char kBadMesh[] = "bad_mesh";          ///< indices out of range, not manifold, not oriented
inline constexpr char kBadGarment[] = "bad_garment";    ///< garment YAML: unknown key, value out of range
inline constexpr char kUnknownLine[] =
    "unknown_line";  ///< a line or node that the control mesh does not have
inline constexpr char kBadTemplate[] = "bad_template";  ///< control mesh template YAML
inline constexpr char kBadOption[] = "bad_option";      ///< an option or parameter out of range
inline constexpr char kCannotWrite[] = "cannot_write";  ///< a folder that is read-only, full or missing
inline constexpr char kSurfaceFailed[] =
    "surface_failed";  ///< the process that makes the surface crashed or took too much
inline constexpr char kMissingSensor[] = "missing_sensor";  ///< a sensor of the booth sent nothing in time
inline constexpr char kLateCloud[] =
    "late_cloud";  ///< a sensor's cloud came after its capture had been published
inline constexpr char kNoStamp[] = "no_stamp";                ///< a sensor's cloud without a time
inline constexpr char kNoTransform[] = "no_transform";        ///< tf has no transform for a sensor
inline constexpr char kWrongReference[] = "wrong_reference";  ///< a reference that was made on another mesh
inline constexpr char kTooFewData[] = "too_few_data";         ///< too little to calibrate or to compare by
inline constexpr char kNotSettled[] = "not_settled";    ///< a fit that a calibration needs did not converge
inline constexpr char kAtBound[] = "at_bound";          ///< a calibration that ran into its bounds
inline constexpr char kOtherPerson[] = "other_person";  ///< a second scan of somebody else
inline constexpr char kOtherPose[] = "other_pose";      ///< a second scan in another pose
inline constexpr char kCoatOn[] = "coat_on";            ///< a second scan with thick clothes on
inline constexpr char kBadModel[] =
    "bad_model";  ///< a registered body model whose arrays do not fit each other
inline constexpr char kOtherModel[] =
    "other_model";  ///< registered with another body model file than this build's
inline constexpr char kTriggerFailed[] = "trigger_failed";  ///< the booth could not be triggered
inline constexpr char kTimedOut[] = "timed_out";            ///< a capture that did not finish in time
inline constexpr char kDeadStage[] = "dead_stage";          ///< a node that a capture needs does not run
inline constexpr char kSuperseded[] = "superseded";  ///< a newer scan arrived before this one was finished
inline constexpr char kLostMessage[] =
    "lost_message";                                   ///< the stage before published it, and it did not come
inline constexpr char kNothingYet[] = "nothing_yet";  ///< asked for a result before there is one
}  // namespace refusal

/// Bad input, refused by name. Thrown by the cores; `fit` reports it as exit code 3 with `reason`, a node as
/// diagnostics and a log line, and keeps running.
class Refusal : public std::runtime_error {
 public:
  Refusal(std::string code, const std::string& message)
      : std::runtime_error(message), code_(std::move(code)) {}

  /// One of the names above.
  const std::string& code() const { return code_; }

 private:
  std::string code_;
};

}  // namespace tensegric_fit::geometry
