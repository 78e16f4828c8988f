#include "rviz/sentence.hpp"

#include <algorithm>

#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {

Sentence::Sentence(int lines, const char* style) {
  setTextFormat(Qt::PlainText);  // names of garments and scans are from outside
  setWordWrap(true);
  setStyleSheet(style);
  setAlignment(Qt::AlignLeft | Qt::AlignTop);
  setFixedHeight(lines * fontMetrics().lineSpacing() + 2);
}

void Sentence::say(const std::string& words, const std::string& hover) {
  words_ = inspect::text(words);
  setToolTip(inspect::text(hover.empty() ? words : hover));
  setAccessibleName(words_);
  shorten();
}

void Sentence::resizeEvent(QResizeEvent* event) {
  QLabel::resizeEvent(event);
  shorten();
}

void Sentence::shorten() {
  ensurePolished();  // bold words are wider
  const QRect place = contentsRect();
  const auto fits = [&](const QString& shown) {
    const QRect room(0, 0, place.width(), 100 * place.height());
    const QRect taken = fontMetrics().boundingRect(room, Qt::TextWordWrap, shown);
    return taken.width() <= place.width() && taken.height() <= place.height();
  };
  QString shown = words_;
  int end = words_.size();
  while (end > 0 && !fits(shown)) {
    end = words_.lastIndexOf(' ', end - 1);
    shown = words_.left(std::max(end, 0)) + QString(" \u2026");
  }
  setText(shown);
}

}  // namespace tensegric_fit::inspect
