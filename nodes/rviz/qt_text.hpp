/// Words of this project to Qt's.
#pragma once

#include <QLabel>
#include <QString>
#include <string>

namespace tensegric_fit::inspect {

inline QString text(const std::string& words) {
  return QString::fromStdString(words);
}

/// Labels of the panel have a fixed height: what does not fit is there on hover.
inline void show_words(QLabel* label, const std::string& words) {
  label->setText(text(words));
  label->setToolTip(text(words));
}

}  // namespace tensegric_fit::inspect
