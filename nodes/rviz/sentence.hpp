/// Words in a place of so many lines, so that nothing below moves under the mouse. Words that do not fit end
/// in an ellipsis, and are there on hover.
#pragma once

#include <QLabel>
#include <string>

namespace tensegric_fit::inspect {

class Sentence : public QLabel {
 public:
  explicit Sentence(int lines, const char* style = "");

  /// `hover`: what is said on hover; the same words where none is given.
  void say(const std::string& words, const std::string& hover = "");

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void shorten();

  QString words_;
};

}  // namespace tensegric_fit::inspect
