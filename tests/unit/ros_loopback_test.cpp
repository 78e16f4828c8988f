/// Sockets of programs that link the ROS room stay on this machine where ROS is to.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "ros/log_words.hpp"

namespace tensegric_fit::node {
namespace {

/// The address that a socket has which asked for any.
std::string address_of_any() {
  const int number = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  EXPECT_EQ(bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  socklen_t length = sizeof address;
  EXPECT_EQ(getsockname(number, reinterpret_cast<sockaddr*>(&address), &length), 0);
  close(number);
  return inet_ntoa(address.sin_addr);
}

TEST(Loopback, FollowsRosHostnameThenRosIp) {
  ASSERT_EQ(without_figures("1"), "#");  // the library is there
  unsetenv("ROS_HOSTNAME");
  unsetenv("ROS_IP");
  EXPECT_EQ(address_of_any(), "0.0.0.0");
  setenv("ROS_IP", "127.0.0.1", 1);
  EXPECT_EQ(address_of_any(), "127.0.0.1");
  setenv("ROS_HOSTNAME", "booth", 1);
  EXPECT_EQ(address_of_any(), "0.0.0.0");
  setenv("ROS_HOSTNAME", "localhost", 1);
  EXPECT_EQ(address_of_any(), "127.0.0.1");
}

}  // namespace
}  // namespace tensegric_fit::node
