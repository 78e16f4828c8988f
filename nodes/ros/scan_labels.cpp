#include "ros/scan_labels.hpp"

#include <algorithm>

namespace tensegric_fit::node {

void ScanLabels::add(const ScanLabel& label) {
  ScanLabel known = of(label.scan_id);
  if (!label.source.empty()) known.source = label.source;
  if (!label.customer.empty()) known.customer = label.customer;
  known.header = label.header;
  drop(label.scan_id);
  labels_.push_back(known);
  if (labels_.size() > kKept) labels_.pop_front();
}

void ScanLabels::drop(const std::string& scan_id) {
  labels_.erase(std::remove_if(labels_.begin(), labels_.end(),
                               [&](const ScanLabel& label) { return label.scan_id == scan_id; }),
                labels_.end());
}

ScanLabel ScanLabels::of(const std::string& scan_id) const {
  const auto known = std::find_if(labels_.begin(), labels_.end(),
                                  [&](const ScanLabel& label) { return label.scan_id == scan_id; });
  if (known != labels_.end()) return *known;
  ScanLabel label;
  label.scan_id = scan_id;
  return label;
}

}  // namespace tensegric_fit::node
