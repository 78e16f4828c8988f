#include "ros/export_desk.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "geometry/status.hpp"
#include "ros/export_folders.hpp"
#include "ros/held_scan.hpp"
#include "ros/log_words.hpp"

namespace tensegric_fit::node {
namespace {

/// What went wrong goes into the response. True: nothing did.
template <typename Response, typename Work>
bool answered(Response& response, const Work& work) {
  try {
    work();
    return true;
  } catch (const geometry::Refusal& refusal) {
    response.code = refusal.code();
    response.message = refusal.what();
  } catch (const std::exception& error) {
    response.code = "internal_error";
    response.message = error.what();
  }
  ROS_ERROR("export: %s",
            log_words(response.code).c_str());  // the caller has the sentence, with the folder's name
  return false;
}

/// `forget` may have been ordered while it was written, for longer than the vault waits or where the vault
/// does not look.
void leave_nothing_forgotten(const std::string& scan_id, const std::string& directory,
                             ExportFit::Response& response) {
  if (!HeldScan::of_process().is_forgotten(scan_id)) return;
  response.files.clear();
  std::vector<geometry::Refusal> left;
  std::error_code gone;  // the vault may have been there
  if (std::filesystem::exists(directory, gone)) delete_exports(directory, scan_id, left);
  if (!left.empty()) throw left.front();
  throw geometry::Refusal(geometry::refusal::kNothingYet, "the scan was forgotten");
}

}  // namespace

ExportDesk::ExportDesk(const ros::NodeHandle& node, ExportOptions options)
    : options_(std::move(options)), spinner_(1, &queue_) {
  ros::NodeHandle own(node);
  own.setCallbackQueue(&queue_);
  services_ = {own.advertiseService("export_fit", &ExportDesk::on_export, this),
               own.advertiseService("delete_export", &ExportDesk::on_delete, this)};
  // A name outlives its scan here: a label is kept for whom it may still be asked.
  orders_ = ros::NodeHandle(node).subscribe<ForgetOrder>("forget/order", 4,
                                                         [this](const ForgetOrder::ConstPtr& order) {
                                                           const std::lock_guard<std::mutex> lock(mutex_);
                                                           if (order->step == ForgetOrder::LET_GO)
                                                             labels_.drop(order->scan_id);
                                                         });
  spinner_.start();
}

void ExportDesk::keep(const FittedScan& scan) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fitted_ = scan;
}

void ExportDesk::keep(const LineForces::ConstPtr& forces) {
  const std::lock_guard<std::mutex> lock(mutex_);
  forces_ = forces;
}

void ExportDesk::keep(const ScanLabel& label) {
  const std::lock_guard<std::mutex> lock(mutex_);
  labels_.add(label);
}

FittedScan ExportDesk::kept() {
  const std::lock_guard<std::mutex> lock(mutex_);
  FittedScan scan = fitted_;
  scan.forces = forces_;
  if (scan.body) scan.label = labels_.of(scan.body->scan_id);
  return scan;
}

bool ExportDesk::on_export(ExportFit::Request& request, ExportFit::Response& response) {
  response.exported = answered(response, [&] {
    const FittedScan scan = kept();
    if (!scan.deformed) throw geometry::Refusal(geometry::refusal::kNothingYet, "no fit has ended so far");
    if (!request.scan_id.empty() && request.scan_id != scan.body->scan_id)
      throw geometry::Refusal(
          geometry::refusal::kNothingYet,
          fmt::format("no fit of scan {} is at hand, but one of {}", request.scan_id, scan.body->scan_id));
    // First held, then asked for: `forget` waits for what is written, or nothing is.
    const HeldScan::Export writing(HeldScan::of_process(), scan.body->scan_id);
    if (HeldScan::of_process().is_forgotten(scan.body->scan_id))
      throw geometry::Refusal(geometry::refusal::kNothingYet, "the scan was forgotten");
    response.files = export_fit(scan, request.directory, options_);
    leave_nothing_forgotten(scan.body->scan_id, request.directory, response);
    response.message = "wrote scan " + scan.body->scan_id + ", garment " + scan.fit->garment;
  });
  return true;
}

bool ExportDesk::on_delete(DeleteExport::Request& request, DeleteExport::Response& response) {
  response.deleted = answered(response, [&] {
    std::vector<geometry::Refusal> left;
    response.folders = delete_exports(request.directory, request.scan_id, left).exports;
    if (!left.empty()) throw left.front();
    if (response.folders.empty())
      throw geometry::Refusal(
          geometry::refusal::kNothingYet,
          fmt::format("no export of scan {} in '{}'; what was left of exports that were cut off was deleted, "
                      "perhaps of other scans",
                      request.scan_id, request.directory));
    response.message = fmt::format("deleted {} exports of scan {}", response.folders.size(), request.scan_id);
  });
  return true;
}

}  // namespace tensegric_fit::node
