/// Exports that only the holder of a private key can read.
#pragma once

#include <string>
#include <vector>

#include "files/whole_folder.hpp"

namespace tensegric_fit::node {

inline constexpr char kSealedFile[] = "fit.tar.age";

/// \throw Refusal bad_option: no public key as `age-keygen` and `ssh-keygen` write them, or there is no age
void check_recipient(const std::string& recipient);

/// The files as one tar archive, encrypted to that public key by the program `age`. What is not encrypted
/// never reaches the disk. \throw Refusal cannot_write: age failed
std::string sealed(const std::vector<files::FileContent>& files, const std::string& recipient);

}  // namespace tensegric_fit::node
