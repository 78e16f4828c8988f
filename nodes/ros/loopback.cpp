// roscpp binds its XML-RPC server to all addresses, ROS_HOSTNAME or not (that of topics it does not): others
// in the network could shut nodes down or send them to publishers of their own. It has no setting for that,
// so the call itself is ours in programs that link this library.
#include "ros/loopback.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace tensegric_fit::node {

bool is_for_this_machine_only() {
  if (const char* name = std::getenv("ROS_HOSTNAME")) return std::strcmp(name, "localhost") == 0;
  const char* address = std::getenv("ROS_IP");
  return address != nullptr && (std::strncmp(address, "127.", 4) == 0 || std::strcmp(address, "::1") == 0);
}

}  // namespace tensegric_fit::node

extern "C" int bind(int fd, const sockaddr* addr, socklen_t len) noexcept {
  sockaddr_in any{};
  sockaddr_in6 any6{};
  if (!tensegric_fit::node::is_for_this_machine_only() || addr == nullptr)
    return static_cast<int>(syscall(SYS_bind, fd, addr, len));
  if (addr->sa_family == AF_INET && len == sizeof any) {
    std::memcpy(&any, addr, sizeof any);
    if (any.sin_addr.s_addr == htonl(INADDR_ANY)) any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return static_cast<int>(syscall(SYS_bind, fd, &any, len));
  }
  if (addr->sa_family == AF_INET6 && len == sizeof any6) {
    std::memcpy(&any6, addr, sizeof any6);
    if (std::memcmp(&any6.sin6_addr, &in6addr_any, sizeof in6addr_any) == 0)
      any6.sin6_addr = in6addr_loopback;
    return static_cast<int>(syscall(SYS_bind, fd, &any6, len));
  }
  return static_cast<int>(syscall(SYS_bind, fd, addr, len));
}
