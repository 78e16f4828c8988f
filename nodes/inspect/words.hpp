/// Everything that display and panel say to a person, in one place, to be translated.
#pragma once

#include <Eigen/Core>
#include <string>

#include "inspect/colour_scale.hpp"

namespace tensegric_fit::inspect::words {

// The display: choices.
inline constexpr char kAfter[] = "After", kBefore[] = "Before", kSideBySide[] = "Side by side",
                      kBlend[] = "Blend", kGhost[] = "Ghost", kWipe[] = "Wipe";
inline constexpr char kDistortion[] = "Distortion", kStretch[] = "Stretch", kDisplacement[] = "Displacement",
                      kPlain[] = "Plain";
inline constexpr char kFixed[] = "Fixed", kAutomatic[] = "Automatic";

// The display: help.
inline constexpr char
    kShowHelp[] =
        "The body under the garment, as scanned, both side by side, between the two, with the scan as a "
        "ghost "
        "over it, or the scan left and the garment right of a border.",
    kBlendHelp[] = "Blend: 0 is the body as scanned, 1 under the garment. Wipe: where the border lies.",
    kPaleHelp[] = "What is shown is of an earlier scan: all of it pale. The panel sets it.",
    kUnheldHelp[] = "Skin that the garment does not reach or hold is green.",
    kUnheldLegend[] = "not reached or not held by the garment",
    kColourHelp[] =
        "What the colours of the skin stand for: its area or its length after / before, or how far it moved.",
    kScaleHelp[] = "Fixed: the same colours for every body. Automatic: as wide as this body's values.",
    kLegendHelp[] = "The scale of colours, in the lower left corner.",
    kOpacityHelp[] = "1: opaque. Below, what is inside shows through the skin.",
    kLinesHelp[] = "The garment's lines, from slack (yellow) to tight (brown).",
    kLandmarksHelp[] = "Blue; orange where they are unsure.", kNamesHelp[] = "The landmarks' names.",
    kGirthsHelp[] = "The tapes of the girths, as they were measured, carried along with the skin.",
    kModelHelp[] =
        "The body model that was registered to the scan, in the colours of its parts, carried along with the "
        "skin.",
    kControlHelp[] = "The control mesh that the fit is made with.",
    kMembersHelp[] = "Forces in the model: red where it pulls, blue where it is pressed.",
    kTopicsHelp[] = "Where the body comes from.", kBodyHelp[] = "The body as scanned.",
    kWornHelp[] = "The body under the garment.",
    kPointedHelp[] = "Click on the body to ask for the value there.",
    kPositionHelp[] = "In the body frame: origin on the floor between the feet.";

// The display: status.
inline constexpr char kNothingYet[] = "nothing came so far", kDrawing[] = "Drawing", kPlace[] = "Place";
std::string of_scan(const std::string& scan_id);
std::string refused(const std::string& code, const std::string& message);
std::string no_transform(const std::string& frame, const std::string& fixed_frame);

/// What stands on a legend.
struct ScaleWords {
  const char *title, *low, *high;
};
const ScaleWords& scale_words(ColourBy by);

// What was pointed at: "skin area 93 %: pressed together"; "12.1 cm forward, 8.0 cm to her left, 118.2 cm
// up"; "2.1 cm from the left bust point".
std::string value_there(ColourBy by, double value);
std::string position(const Eigen::Vector3d& place);
std::string nearest(const std::string& landmark, double distance);
/// Value and landmark, beside the mark on the skin.
std::string pointed(ColourBy by, double value, const std::string& landmark, double distance);

// Reports. "upper_arm_L" and "girth": left upper arm girth; "stature" needs no kind.
std::string measure(const std::string& name, const std::string& kind);
/// In centimetres with a sign, and none where nothing is seen of it.
std::string centimetre_change(double metres);
/// The change between two lengths, each rounded to the millimetre as shown. Metres.
std::string centimetre_change(double from, double to);

}  // namespace tensegric_fit::inspect::words
