/// Everything that the panel says to a person, in one place with words.hpp, to be translated.
#pragma once

#include <string>
#include <vector>

#include "inspect/bra_size.hpp"

namespace tensegric_fit::inspect::words {

// Labels; an ampersand comes before the key that reaches it with Alt.
inline constexpr char kGarment[] = "&Garment", kPutOn[] = "&Put on", kUndo[] = "&Undo", kRedo[] = "R&edo",
                      kLinked[] = "&Both sides alike", kReset[] = "&Reset", kCompare[] = "&Compare",
                      kExport[] = "E&xport", kFolder[] = "&Folder", kCustomer[] = "Custo&mer",
                      kMarks[] = "Mar&ks", kBlendLabel[] = "&Scan to garment", kRegions[] = "Regions";
// How the body before is shown with the worn one.
inline constexpr char kAlone[] = "garment alone", kAsGhost[] = "scan as a ghost",
                      kBothSides[] = "scan left, garment right", kAsWipe[] = "wipe from scan to garment",
                      kFading[] = "fade from scan to garment",
                      kCompareHelp[] = "The body before beside, over or in place of the one with the garment";
inline constexpr char kViewFront[] = "Front", kViewLeft[] = "Left", kViewBack[] = "Back",
                      kViewRight[] = "Right", kViewAll[] = "All", kViewFollows[] = "follows",
                      kMarksHelp[] = "Landmarks and the tapes of the girths, shown or not",
                      kViewHelp[] = "The view from there; All: her whole body, or where the garment is",
                      kViewFollowsHelp[] = "Another garment turns the view to where it acts";
inline constexpr char kLine[] = "Line", kNeutral[] = "neutral length", kNow[] = "now", kPull[] = "pull";
inline constexpr char kMeasure[] = "Measure", kScanned[] = "scan", kWornGirth[] = "worn",
                      kChange[] = "change", kBraSize[] = "Bra size", kNoSize[] = "-",
                      kLift[] = "lift of the bust", kApart[] = "bust points apart";
inline constexpr char kOldBody[] = " Shown pale below: the body before.",
                      kOldBodyGone[] = " The body before is no longer shown.";
inline constexpr char kOfAnotherBody[] = "This garment lies on the skin of another body: choose one.";
inline constexpr char kNoLines[] = "No garment is worn so far.";
inline constexpr char kRegionHelp[] = "Without its lines nothing pulls there. One region stays on.";
inline constexpr char kGarmentHelp[] = "A garment's name, several joined by + (B1+H4), or a garment file.";

// How the pipeline stands.
inline constexpr char kPipelineNotRunning[] =
    "The fitting pipeline is not running. Start it: roslaunch tensegric_fit pipeline.launch. If it runs in a "
    "namespace: ROS_NAMESPACE=NAME roslaunch tensegric_fit inspect.launch",
                      kReady[] = "Ready.", kWaitsForScan[] = "Waiting for a scan.",
                      kReadyToMeasure[] =
                          "Ready. It measures only: none of the stages that fit garments was started.";
std::string silent(const std::string& stage);
std::string stage_refused(const std::string& stage, const std::string& message);
std::string working(const std::string& stage);

// What became of a request.
inline constexpr char kNoAnswer[] = "The fitting pipeline does not answer; what is shown is the last fit.",
                      kEmptyFolder[] = "Name a folder for the export.",
                      kNothingToExport[] = "Nothing was exported: no body under a garment is shown so far.",
                      kOldNotExported[] =
                          "Nothing was exported: another scan has come since the body that is shown.",
                      kTooManyLines[] = "A garment with more than 256 lines is not shown.",
                      kOldNotNamed[] =
                          "The customer was not noted: another scan has come since the body that is shown.";
std::string solving(int iteration);
std::string not_accepted(const std::string& message);
std::string exported(int files, const std::string& folder);
/// `source`: file that the scan came from, or empty.
std::string customer_help(const std::string& source);
std::string not_exported(const std::string& message);

/// What rviz's view cannot be turned for.
inline constexpr char kNoOrbit[] = "The view is not turned: rviz shows another than its Orbit view.";
std::string unknown_frame(const std::string& frame);

/// Of a parameter of rviz's node that is no good: why, and the seconds in its place.
std::string default_taken(const std::string& why, double seconds);

/// A fit that has ended: "B1: fits (12 ms)", or what is wrong with it.
std::string fit_ended(const std::string& garment, const std::string& status, const std::string& note,
                      double milliseconds);

/// Without what is in "(Details: ...)": it is there on hover.
std::string without_details(std::string words);

/// What a line does beyond its figures; empty where there is nothing to say. Lengths in metres.
struct LineOutcome {
  double request, ratio;  ///< asked and reached, over the length at rest
  double tension;
  double reachable;  ///< the shortest that it came to
  bool infeasible;   ///< the fit
};
std::string line_warning(const LineOutcome& line);

/// "" where the skin is neither pressed nor stretched as far as that.
std::string over_constriction(double area, const std::string& landmark);

/// Warnings of a fit in one paragraph: the first two, and how many more places there are.
std::string warnings(const std::vector<std::string>& messages);

/// "75C", "75C or 75D" on a border, "-" without a size.
std::string sizes(const std::vector<BraSize>& sizes);
std::string volume(const std::string& region, double before, double after);
std::string centimetres(double metres);
std::string change(double metres);
/// "+6 mm".
std::string rise(double metres);
std::string per_cent(double ratio);

}  // namespace tensegric_fit::inspect::words
