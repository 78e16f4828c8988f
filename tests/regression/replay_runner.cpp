#include "replay_runner.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

Replayed replay(const std::string& bag, const std::string& scan_id, const YAML::Node& pipeline,
                bool measure_only, const std::string& folder) {
  const fs::path place = fs::absolute(folder);
  const fs::path out = place / "replayed.bag", log = place / "launch.log";
  fs::remove(out);
  std::ofstream(place / "config.yaml") << pipeline << '\n';
  // The set-up file of the tree that this program was built in, so that no environment is needed.
  const fs::path setup = fs::read_symlink("/proc/self/exe").parent_path() / "../../setup.bash";
  const int port = free_port();
  const std::string command = fmt::format(
      "exec > '{}' 2>&1; . '{}'; export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:{} "
      "ROS_HOME='{}'; "
      "exec timeout -k 5 {} roslaunch -p {} tensegric_fit replay.launch bag:='{}' out:='{}' config:='{}' "
      "measure_only:={} timeout:=40",
      log.string(), setup.string(), port, (place / "ros_home").string(), kPatience, port,
      fs::absolute(bag).string(), out.string(), (place / "config.yaml").string(), measure_only);
  const std::string quoted = "bash -c \"" + command + "\"";
  const int status = std::system(quoted.c_str());
  Replayed replayed;
  replayed.fault = complaint_in(log);
  if (fs::exists(out))
    replayed.recording = recording_in(out, scan_id);
  else if (replayed.fault.empty())
    replayed.fault = fmt::format("roslaunch ended with {} and wrote nothing: see {}", status, log.string());
  return replayed;
}

}  // namespace tensegric_fit::regression
