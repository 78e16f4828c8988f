/// A garment line on the panel: slider, per cent, centimetres, and what became of it.
#pragma once

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QObject>
#include <QSlider>
#include <string>

namespace tensegric_fit::inspect {

/// Fills two rows of a grid: the second has slider and pressure.
class LineRow : public QObject {
  Q_OBJECT
 public:
  /// Columns of the grid.
  enum { kName, kPerCent, kCentimetres, kNow, kPull };

  /// `number` from 1: Alt and this digit reach the slider.
  LineRow(const std::string& line, int number, QGridLayout* grid);

  const std::string& line() const { return line_; }
  bool is_held() const { return slider_->isSliderDown(); }

  /// The length at rest in metres; 0: not known, and no centimetres.
  void set_asked(double ratio, double length);
  /// A name with a warning is red, the warning there on hover.
  void set_outcome(double ratio, const std::string& warning);
  /// Nothing is known of what became of it.
  void forget_outcome();
  /// Empty where they are not known; `help` on hover.
  void set_force(const std::string& pull, const std::string& pressure, const std::string& help);
  void set_ratio_now(double ratio);
  void set_enabled(bool enabled);
  /// Tab comes to it after `before`; the last of its parts.
  QWidget* follow(QWidget* before);

 Q_SIGNALS:
  void asked(const QString& line, double ratio);
  void settled();

 private:
  const std::string line_;
  double length_ = 0;
  QSlider* slider_;
  QDoubleSpinBox *per_cent_, *centimetres_;
  QLabel *name_, *now_, *pull_, *pressure_;
};

}  // namespace tensegric_fit::inspect
