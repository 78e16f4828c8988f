#include "rviz/line_row.hpp"

#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "inspect/fit_session.hpp"
#include "inspect/panel_words.hpp"
#include "rviz/qt_text.hpp"
#include "rviz/wheel.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kTicks = 200;                  // of the slider, for a ratio of 1: half a per cent each
constexpr double kWholeCircumference = 300;  // cm
constexpr int kShortestSlider = 200, kLongestName = 130;  // pixels

/// Shows points, as all of the panel does, and takes a typed comma for one: in C's locale it would part
/// thousands.
class NumberBox : public QDoubleSpinBox {
 public:
  NumberBox() { setLocale(QLocale::c()); }
  QValidator::State validate(QString& typed, int& place) const override {
    QString text = typed;
    text.replace(',', '.');
    return QDoubleSpinBox::validate(text, place);
  }
  double valueFromText(const QString& typed) const override {
    QString text = typed;
    text.replace(',', '.');
    return QDoubleSpinBox::valueFromText(text);
  }
};

QDoubleSpinBox* box(const char* unit, double low, double high, double step) {
  auto* made = new NumberBox;
  made->setSuffix(QString(" ") + unit);
  made->setDecimals(1);
  made->setRange(low, high);
  made->setSingleStep(step);
  made->setKeyboardTracking(false);  // a number that is typed counts when it is whole
  return made;
}

}  // namespace

LineRow::LineRow(const std::string& line, int number, QGridLayout* grid)
    : line_(line),
      slider_(new QSlider(Qt::Horizontal)),
      per_cent_(box("%", 100 * FitSession::kLeast, 100 * FitSession::kMost, 0.5)),
      centimetres_(box("cm", 0, kWholeCircumference, 0.5)),
      name_(new QLabel),
      now_(new QLabel),
      pull_(new QLabel),
      pressure_(new QLabel) {
  slider_->setObjectName(text("slider_" + line));
  slider_->setRange(static_cast<int>(std::lround(kTicks * FitSession::kLeast)),
                    static_cast<int>(std::lround(kTicks * FitSession::kMost)));
  slider_->setPageStep(kTicks / 20);
  slider_->setMinimumWidth(kShortestSlider);
  const QString name = text(line);
  for (QWidget* widget : {static_cast<QWidget*>(slider_), static_cast<QWidget*>(per_cent_),
                          static_cast<QWidget*>(centimetres_)}) {
    widget->setAccessibleName(name);
    new WheelInFocus(widget);
  }
  name_->setText(QString("&%1 %2").arg(number).arg(
      name_->fontMetrics().elidedText(name, Qt::ElideMiddle, kLongestName)));
  name_->setToolTip(name);
  name_->setBuddy(slider_);
  const int row = 2 * number - 1;  // below the headings
  grid->addWidget(name_, row, kName);
  grid->addWidget(per_cent_, row, kPerCent);
  grid->addWidget(centimetres_, row, kCentimetres);
  grid->addWidget(now_, row, kNow, Qt::AlignRight);
  grid->addWidget(pull_, row, kPull, Qt::AlignRight);
  grid->addWidget(slider_, row + 1, kName, 1, kPull);
  grid->addWidget(pressure_, row + 1, kPull, Qt::AlignRight);

  const auto ask = [this](double ratio) { Q_EMIT asked(text(line_), ratio); };
  connect(slider_, &QSlider::valueChanged, this,
          [ask](int ticks) { ask(static_cast<double>(ticks) / kTicks); });
  connect(slider_, &QSlider::sliderReleased, this, &LineRow::settled);
  const auto changed = qOverload<double>(&QDoubleSpinBox::valueChanged);
  connect(per_cent_, changed, this, [ask](double value) { ask(value / 100); });
  connect(centimetres_, changed, this, [this, ask](double value) {
    if (length_ > 0) ask(value / 100 / length_);
  });
  for (QDoubleSpinBox* each : {per_cent_, centimetres_})
    connect(each, &QDoubleSpinBox::editingFinished, this, &LineRow::settled);
}

void LineRow::set_asked(double ratio, double length) {
  const QSignalBlocker slider(slider_), share(per_cent_), cm(centimetres_);
  length_ = length;
  if (!slider_->isSliderDown()) slider_->setValue(static_cast<int>(std::lround(kTicks * ratio)));
  const double least = std::min(FitSession::kLeast, ratio), most = std::max(FitSession::kMost, ratio);
  per_cent_->setRange(100 * least, 100 * most);
  per_cent_->setValue(100 * ratio);
  centimetres_->setEnabled(length > 0);
  if (length > 0) {
    centimetres_->setRange(100 * length * least, 100 * length * most);
    centimetres_->setValue(100 * length * ratio);
  }
}

void LineRow::set_ratio_now(double ratio) {
  now_->setText(text(words::per_cent(ratio)));
}

void LineRow::set_force(const std::string& pull, const std::string& pressure, const std::string& help) {
  pull_->setText(text(pull));
  pressure_->setText(text(pressure));
  for (QLabel* label : {pull_, pressure_}) label->setToolTip(text(help));
}

void LineRow::set_outcome(double ratio, const std::string& warning) {
  set_ratio_now(ratio);
  name_->setStyleSheet(warning.empty() ? "" : "color: #b2182b");
  name_->setToolTip(text(warning.empty() ? line_ : warning));
}

void LineRow::forget_outcome() {
  now_->clear();
  name_->setStyleSheet("");
  name_->setToolTip(text(line_));
  set_force("", "", "");
}

QWidget* LineRow::follow(QWidget* before) {
  QWidget::setTabOrder(before, slider_);
  QWidget::setTabOrder(slider_, per_cent_);
  QWidget::setTabOrder(per_cent_, centimetres_);
  return centimetres_;
}

void LineRow::set_enabled(bool enabled) {
  slider_->setEnabled(enabled);
  per_cent_->setEnabled(enabled);
  centimetres_->setEnabled(enabled && length_ > 0);
}

}  // namespace tensegric_fit::inspect
