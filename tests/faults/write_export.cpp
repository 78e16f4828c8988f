// Writes an export of a small fit, to be ended at its writes (every_write.py): write_export FOLDER
#include <cstdio>

#include "geometry/status.hpp"
#include "ros_exported_scan.hpp"

namespace tensegric_fit::node {
namespace {

struct SmallFit : ExportFitTest {
  static FittedScan scan() { return fitted("1.000000000-00000001"); }
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int count, char** words) {
  if (count != 2) return 2;
  try {
    tensegric_fit::node::export_fit(tensegric_fit::node::SmallFit::scan(), words[1],
                                    tensegric_fit::node::kWhole);
  } catch (const tensegric_fit::geometry::Refusal& refusal) {
    std::fprintf(stderr, "%s: %s\n", refusal.code().c_str(), refusal.what());
    return refusal.code() == tensegric_fit::geometry::refusal::kCannotWrite ? 1 : 3;
  }
  return 0;
}
