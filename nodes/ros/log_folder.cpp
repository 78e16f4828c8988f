#include "ros/log_folder.hpp"

#include <ros/file_log.h>
#include <ros/param.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace tensegric_fit::node {

namespace fs = std::filesystem;

void close_log_folder() {
  const fs::path folder = ros::file_log::getLogDirectory();
  std::string run;
  if (!ros::param::get("/run_id", run) || folder.filename() != run) return;
  std::error_code not_ours;
  fs::permissions(folder, fs::perms::owner_all, not_ours);
}

}  // namespace tensegric_fit::node
