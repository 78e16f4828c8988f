#include "subjects.hpp"

#include <algorithm>
#include <filesystem>

#include "assembler/assembler.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "scan_files/scan_file.hpp"
#include "truth_reader.hpp"
#include "virtual_booth/hidden_figures.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit::population {
namespace {

namespace fs = std::filesystem;

/// As the assembler node has it: each sensor's cloud in its own frame.
geometry::PointCloud assembled(const virtual_booth::VirtualScan& scan, int sensors_per_column) {
  assembler::Capture capture{0, 0, {}};
  std::vector<Eigen::Isometry3d> booth_from_sensor;
  for (virtual_booth::SensorScan& sensor : virtual_booth::by_sensor(scan)) {
    booth_from_sensor.push_back(sensor.pose.booth_from_sensor);
    for (Eigen::Vector3d& p : sensor.cloud.points) p = booth_from_sensor.back().inverse() * p;
    const auto cloud = std::make_shared<assembler::SensorCloud>();
    cloud->cloud = std::move(sensor.cloud);
    capture.clouds.push_back(cloud);
  }
  assembler::AssemblerOptions options;
  options.sensors_per_column = sensors_per_column;
  return assembler::assemble(capture, booth_from_sensor, options).cloud;
}

class Booth : public Family {
 public:
  explicit Booth(virtual_booth::Family family) : family_(family) {}
  std::string name() const override { return virtual_booth::families()[static_cast<std::size_t>(family_)]; }

  std::vector<std::string> bodies(int first, int count) const override {
    std::vector<std::string> seeds;
    for (int seed = first; seed < first + count; ++seed) seeds.push_back(std::to_string(seed));
    return seeds;
  }

  Subject body(const std::string& name, Input input) const override {
    const auto seed = static_cast<std::uint64_t>(std::stoul(name));
    virtual_body::VirtualBody body = virtual_booth::random_customer(family_, seed);
    Subject subject{{body.truth, body.doubts}, {}, {}};
    if (input == Input::surface) {
      subject.surface = std::move(body.mesh);
      return subject;
    }
    const virtual_booth::ScannerOptions scanner = virtual_booth::random_scanner(seed, body);
    subject.truth.doubts = virtual_booth::doubts_in_booth(body, scanner);
    const virtual_booth::VirtualScan scan = virtual_booth::scan_body(body.mesh, scanner);
    subject.scan = input == Input::merged_scan ? scan.cloud : assembled(scan, scanner.sensors_per_column);
    return subject;
  }

 private:
  virtual_booth::Family family_;
};

class Folder : public Family {
 public:
  explicit Folder(const std::string& path) : path_(path) {
    const std::string ending = "_truth.json";
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      const std::string file = entry.path().filename().string();
      if (file.size() > ending.size() &&
          file.compare(file.size() - ending.size(), ending.size(), ending) == 0)
        names_.push_back(file.substr(0, file.size() - ending.size()));
    }
    std::sort(names_.begin(), names_.end());
    if (names_.empty())
      throw geometry::Refusal(geometry::refusal::kBadOption, path + ": no NAME_truth.json in this folder");
  }
  std::string name() const override { return path_; }

  std::vector<std::string> bodies(int first, int count) const override {
    const std::size_t begin = std::min(names_.size(), static_cast<std::size_t>(std::max(first, 1) - 1));
    const std::size_t end = std::min(names_.size(), begin + static_cast<std::size_t>(count));
    return {names_.begin() + static_cast<long>(begin), names_.begin() + static_cast<long>(end)};
  }

  Subject body(const std::string& name, Input input) const override {
    const std::string base = path_ + "/" + name;
    Subject subject{read_truth(base + "_truth.json", input == Input::surface), {}, {}};
    if (input == Input::surface)
      subject.surface = geometry::read_ply_mesh(base + "_body.ply");
    else
      subject.scan = geometry::points_of(scan_files::read_scan_file(base + "_scan.ply").cloud);
    return subject;
  }

 private:
  std::string path_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<Family> family_named(const std::string& name) {
  const auto& known = virtual_booth::families();
  if (std::find(known.begin(), known.end(), name) != known.end())
    return std::make_unique<Booth>(virtual_booth::family_named(name));
  if (fs::is_directory(name)) return std::make_unique<Folder>(name);
  throw geometry::Refusal(geometry::refusal::kBadOption,
                          "'" + name + "' is neither a body family (model, implicit) nor a folder");
}

}  // namespace tensegric_fit::population
