/// Exports that only the holder of a private key can read.
#pragma once

#include <string>
#include <vector>

#include "files/whole_folder.hpp"

namespace tensegric_fit::node {

inline constexpr char kSealedFile[] = "fit.tar.age";
inline constexpr char kAge[] = "/usr/bin/age";
/// s, in which age has to encrypt an export: a thousand times what it takes.
inline constexpr double kSealingTime = 60;

/// \throw Refusal bad_option: no public key as `age-keygen` and `ssh-keygen` write them, or there is no age
void check_recipient(const std::string& recipient);

/// The files as one tar archive, encrypted to that public key by `program`, which is age. What is not
/// encrypted never reaches the disk. \throw Refusal cannot_write: age failed, or had not ended after
/// `seconds`
std::string sealed(const std::vector<files::FileContent>& files, const std::string& recipient,
                   const std::string& program = kAge, double seconds = kSealingTime);

}  // namespace tensegric_fit::node
