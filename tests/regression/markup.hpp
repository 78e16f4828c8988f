/// Text for XML and HTML.
#pragma once

#include <string>

namespace tensegric_fit::regression {

/// With entities in place of the five letters that markup keeps for itself.
inline std::string markup_safe(const std::string& text) {
  std::string safe;
  for (const char letter : text) switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += letter;
    }
  return safe;
}

}  // namespace tensegric_fit::regression
