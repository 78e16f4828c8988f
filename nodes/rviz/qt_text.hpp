/// Words of this project to Qt's.
#pragma once

#include <QString>
#include <string>

namespace tensegric_fit::inspect {

inline QString text(const std::string& words) {
  return QString::fromStdString(words);
}

}  // namespace tensegric_fit::inspect
