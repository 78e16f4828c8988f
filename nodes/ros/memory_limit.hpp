/// How much memory a node may take.
#pragma once

namespace tensegric_fit::node {

/// Half of the machine's memory for this process's data. roscpp makes room for the arrays of a message before
/// it looks whether their bytes are there, so that a message of 100 bytes can ask for 16 GB; with a limit
/// that is an exception, which roscpp logs, and the message is dropped. For main functions.
void limit_memory();

}  // namespace tensegric_fit::node
