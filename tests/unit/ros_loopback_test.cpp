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

/// The same of the next protocol, which roscpp takes with ROS_IPV6=on. Empty: this machine has none.
std::string address_of_any6() {
  const int number = socket(AF_INET6, SOCK_STREAM, 0);
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  socklen_t length = sizeof address;
  char text[INET6_ADDRSTRLEN] = "";
  if (bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      getsockname(number, reinterpret_cast<sockaddr*>(&address), &length) == 0)
    inet_ntop(AF_INET6, &address.sin6_addr, text, sizeof text);
  close(number);
  return text;
}

TEST(Loopback, HoldsForTheNextProtocol) {
  setenv("ROS_HOSTNAME", "booth", 1);
  if (address_of_any6().empty()) GTEST_SKIP() << "no IPv6 here";
  EXPECT_EQ(address_of_any6(), "::");
  setenv("ROS_HOSTNAME", "localhost", 1);
  EXPECT_EQ(address_of_any6(), "::1");
}

TEST(Loopback, FollowsRosHostnameThenRosIp) {
  ASSERT_EQ(log_words("1"), "#");  // the library is there
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
