/// vault: the service forget, and how long exports are kept.
#include "ros/forget_desk.hpp"
#include "ros/run_node.hpp"

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ForgetDesk>(argc, argv, "vault");
}
