#include "ros/shipped_files.hpp"

#include <ros/package.h>

#include <filesystem>

#include "geometry/status.hpp"

namespace tensegric_fit::node {

namespace fs = std::filesystem;

std::string shipped_folder(const std::string& folder) {
  const std::string package = ros::package::getPath(ROS_PACKAGE_NAME);
  return package.empty() ? "" : package + "/launch/" + folder;
}

std::string shipped_file(const std::string& folder, const std::string& word, const char* code) {
  const fs::path given(word);
  const fs::path file =
      given.has_parent_path() || given.extension() == ".yaml" ? given : fs::path(folder) / (word + ".yaml");
  std::error_code unreadable;
  if (word.empty() || !fs::is_regular_file(file, unreadable))
    throw geometry::Refusal(code, "there is no file '" + file.string() + "'");
  return file.string();
}

}  // namespace tensegric_fit::node
