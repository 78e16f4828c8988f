/// Wheels turn what was chosen by click or key only: what the panel scrolls under the mouse keeps its value.
#pragma once

#include <QEvent>
#include <QWidget>

namespace tensegric_fit::inspect {

class WheelInFocus : public QObject {
 public:
  explicit WheelInFocus(QWidget* control) : QObject(control) {
    control->setFocusPolicy(Qt::StrongFocus);
    control->installEventFilter(this);
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() != QEvent::Wheel || static_cast<QWidget*>(watched)->hasFocus()) return false;
    event->ignore();  // the panel's to scroll by
    return true;
  }
};

}  // namespace tensegric_fit::inspect
