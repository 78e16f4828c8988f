#include "files/owner_only.hpp"

#include <sys/stat.h>

namespace tensegric_fit::files {

void owner_only() {
  umask(S_IRWXG | S_IRWXO);
}

}  // namespace tensegric_fit::files
