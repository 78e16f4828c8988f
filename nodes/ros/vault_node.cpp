/// vault: the service forget, how long exports are kept, and a word where others reach what is about bodies.
#include "ros/forget_desk.hpp"
#include "ros/loopback.hpp"
#include "ros/run_node.hpp"

namespace {

class Vault {
 public:
  Vault(const ros::NodeHandle& node, const ros::NodeHandle& private_node) : desk_(node, private_node) {
    if (!tensegric_fit::node::is_for_this_machine_only())
      ROS_WARN(
          "vault: nodes are reached from other machines, and ROS 1 knows no passwords: whoever reaches a "
          "port can read bodies and measures, publish scans, export and delete fits "
          "(launch/pages/privacy.md, Network)");
  }

 private:
  tensegric_fit::node::ForgetDesk desk_;
};

}  // namespace

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<Vault>(argc, argv, "vault");
}
