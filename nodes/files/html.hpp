/// Pieces of HTML pages that need no other file.
#pragma once

#include <string>

namespace tensegric_fit::files {

/// Text with entities in place of the characters that markup reserves.
std::string html_escaped(const std::string& text);

/// Bytes in base 64 (RFC 4648), for data URLs.
std::string base64(const std::string& bytes);

}  // namespace tensegric_fit::files
