/// The folder of this run's logs.
#pragma once

namespace tensegric_fit::node {

/// Makes it its owner's only: roscore's own rosout writes all that nodes say into it, with the umask of a
/// shell. Needs the master. A folder that other programs log into, too, stays as it is.
void close_log_folder();

}  // namespace tensegric_fit::node
