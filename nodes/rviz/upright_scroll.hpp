/// Scrolls up and down, and asks for the width that its contents need.
#pragma once

#include <QEvent>
#include <QScrollArea>
#include <QScrollBar>

namespace tensegric_fit::inspect {

class UprightScroll : public QScrollArea {
 public:
  explicit UprightScroll(QWidget* inside) {
    setWidgetResizable(true);
    setFrameShape(QFrame::NoFrame);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setWidget(inside);
  }

  QSize minimumSizeHint() const override {
    const int width = widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width();
    return {width, QScrollArea::minimumSizeHint().height()};
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::LayoutRequest) updateGeometry();
    return QScrollArea::eventFilter(watched, event);
  }
};

}  // namespace tensegric_fit::inspect
