#include "replay_runner.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

constexpr char kAssembleLaunch[] = TENSEGRIC_FIT_REGRESSION "/assemble.launch";
constexpr int kPatience = 120;  // seconds that a launch may take; its nodes give up earlier

int free_port() {
  const int socket_ = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool bound = bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(socket_);
  if (!bound) throw std::runtime_error("no free port for a master");
  return ntohs(address.sin_port);
}

// What a launch's log says went wrong, the gravest first; empty: nothing.
std::string complaint_in(const std::string& log) {
  for (const char* word : {"FATAL", "TIMED OUT", "has died"}) {
    std::ifstream in(log);
    for (std::string line; std::getline(in, line);) {
      if (line.find(word) == std::string::npos) continue;
      const std::size_t text = line.find("replay: ");
      if (text != std::string::npos) line = line.substr(text);
      return line.substr(0, line.find('\033'));  // without colours
    }
  }
  return "";
}

fs::path replayed_bag(const ReplayInput& input) {
  return fs::absolute(input.folder) / "replayed.bag";
}

fs::path assembled_bag(const ReplayInput& input) {
  return fs::absolute(input.folder) / "assembled.bag";
}

// Under a master of its own, on a free port. What went wrong, if anything.
std::string launch(const std::string& name, const std::string& file_and_arguments, const fs::path& out,
                   const ReplayInput& input) {
  const fs::path place = fs::absolute(input.folder), config = place / "config.yaml",
                 log = place / (name + ".log");
  fs::remove(out);
  std::ofstream(config) << input.pipeline << '\n';
  // The set-up file of the tree that this program was built in, so that no environment is needed.
  const fs::path setup = fs::read_symlink("/proc/self/exe").parent_path() / "../../setup.bash";
  const int port = free_port();
  const std::string command = fmt::format(
      "exec > '{}' 2>&1; . '{}'; export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:{} "
      "ROS_HOME='{}'; exec timeout -k 5 {} roslaunch -p {} {} bag:='{}' out:='{}' config:='{}'",
      log.string(), setup.string(), port, (place / "ros_home").string(), kPatience, port, file_and_arguments,
      fs::absolute(input.bag).string(), out.string(), config.string());
  const int status = std::system(("bash -c \"" + command + "\"").c_str());
  const std::string fault = complaint_in(log);
  if (!fault.empty() || fs::exists(out)) return fault;
  return fmt::format("roslaunch ended with {} and wrote nothing: see {}", status, log.string());
}

}  // namespace

std::string launch_replay(const ReplayInput& input) {
  return launch("replay",
                fmt::format("tensegric_fit replay.launch measure_only:={} timeout:=40", input.measure_only),
                replayed_bag(input), input);
}

std::string launch_assembly(const ReplayInput& input) {
  return launch("assemble", fmt::format("'{}'", kAssembleLaunch), assembled_bag(input), input);
}

Recording replayed(const ReplayInput& input, const std::string& scan_id) {
  return fs::exists(replayed_bag(input)) ? recording_in(replayed_bag(input), scan_id) : Recording();
}

sensor_msgs::PointCloud2::ConstPtr assembled(const ReplayInput& input) {
  sensor_msgs::PointCloud2::ConstPtr scan;
  if (!fs::exists(assembled_bag(input))) return scan;
  const rosbag::Bag bag(assembled_bag(input));
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) scan = message.instantiate<sensor_msgs::PointCloud2>();
  return scan;
}

}  // namespace tensegric_fit::regression
