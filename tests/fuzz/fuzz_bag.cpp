// Bags, as they are checked and as scans are read from them.
#include "fuzz_target.hpp"
#include "geometry/point_cloud.hpp"
#include "ros/bag_check.hpp"
#include "scan_files/scan_bag.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tensegric_fit;
  const fuzz::InputFile file(data, size, ".bag");
  fuzz::refused_or_done([&] { node::to_text(node::check_bag(file.path()), file.path()); });
  fuzz::refused_or_done([&] { geometry::points_of(scan_files::read_bag_scan(file.path())); });
  return 0;
}
