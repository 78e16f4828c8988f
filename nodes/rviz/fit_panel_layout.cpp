// What the panel is made of, and what is on it.
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>

#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QHBoxLayout>
#include <QShortcut>
#include <QVBoxLayout>

#include "geometry/shipped_files.hpp"
#include "inspect/garment_titles.hpp"
#include "inspect/panel_words.hpp"
#include "inspect/words.hpp"
#include "rviz/fit_panel.hpp"
#include "rviz/qt_text.hpp"
#include "rviz/upright_scroll.hpp"
#include "rviz/wheel.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kPanelWidth = 430;      // pixels
constexpr int kGarmentPicture = 56;   // pixels
constexpr int kShownLetters = 8;      // of a choice, at least: the longest must not widen the panel
constexpr int kLongestCustomer = 60;  // letters of a customer id
constexpr char kWarning[] = "color: #b2182b; font-weight: bold";
constexpr char kDisplay[] = "tensegric_fit/BodyMesh";

Sentence* sentence(QVBoxLayout* layout, int lines, const char* style = "") {
  auto* label = new Sentence(lines, style);
  layout->addWidget(label);
  return label;
}

QComboBox* narrow_choice() {
  auto* box = new QComboBox;
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(kShownLetters);
  new WheelInFocus(box);
  return box;
}

void empty(QWidget* box) {
  delete box->layout();
  qDeleteAll(box->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
}

std::vector<rviz::Display*> displays(rviz::VisualizationManager* manager) {
  std::vector<rviz::Display*> ours;
  rviz::DisplayGroup* all = manager->getRootDisplayGroup();
  for (int i = 0; i < all->numDisplays(); ++i)
    if (all->getDisplayAt(i)->getClassId() == kDisplay) ours.push_back(all->getDisplayAt(i));
  return ours;
}

// Each with its title to be read, and its name to be asked for.
void add_shipped_garments(QComboBox* box) {
  std::string folder = geometry::shipped_folder("garments");
  ros::NodeHandle().getParam("tensegric/garment_directory", folder);
  for (const GarmentTitle& garment : garments_in(folder)) {
    const std::string shown = garment.name + (garment.title.empty() ? "" : ": " + garment.title);
    box->addItem(text(shown), text(garment.name));
    box->setItemData(box->count() - 1, text(garment.about), Qt::ToolTipRole);
    if (!garment.picture.empty()) box->setItemIcon(box->count() - 1, QIcon(text(garment.picture)));
  }
}

}  // namespace

FitPanel::FitPanel(QWidget* parent) : rviz::Panel(parent) {
  auto* inside = new QWidget;
  auto* layout = new QVBoxLayout(inside);
  pipeline_ = sentence(layout, 3);
  progress_ = new QProgressBar;
  progress_->setTextVisible(false);
  progress_->setMaximumHeight(8);
  layout->addWidget(progress_);
  build_garment(layout);
  fit_ = sentence(layout, 2);
  warned_ = sentence(layout, 5, kWarning);
  layout->addWidget(lines_box_ = new QWidget);
  layout->addWidget(regions_box_ = new QWidget);
  build_buttons(layout);
  layout->addWidget(table_ = new GirthTable, 1);
  volumes_ = sentence(layout, 1);
  build_export(layout);
  answer_ = sentence(layout, 2);
  build_lines();

  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(new UprightScroll(inside));
  setMinimumWidth(kPanelWidth);
  const auto* back =
      new QShortcut(QKeySequence::Undo, this, nullptr, nullptr, Qt::WidgetWithChildrenShortcut);
  connect(back, &QShortcut::activated, this, &FitPanel::undo);
  const auto* forth =
      new QShortcut(QKeySequence::Redo, this, nullptr, nullptr, Qt::WidgetWithChildrenShortcut);
  connect(forth, &QShortcut::activated, this, &FitPanel::redo);
}

void FitPanel::build_garment(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(words::kGarment);
  garment_ = narrow_choice();
  garment_->setEditable(true);
  garment_->setInsertPolicy(QComboBox::NoInsert);
  garment_->setIconSize({kGarmentPicture, kGarmentPicture});
  add_shipped_garments(garment_);
  garment_->setCompleter(nullptr);  // it would add a title to the name that is typed
  garment_->setCurrentText("");
  garment_->setToolTip(words::kGarmentHelp);
  label->setBuddy(garment_);
  put_on_ = new QPushButton(words::kPutOn);
  row->addWidget(label);
  row->addWidget(garment_, 1);
  row->addWidget(put_on_);
  layout->addLayout(row);
  connect(garment_, qOverload<int>(&QComboBox::activated), this, [this] { choose(garment_->currentText()); });
  connect(garment_->lineEdit(), &QLineEdit::textEdited, this, [this] { typing_ = true; });
  connect(garment_->lineEdit(), &QLineEdit::returnPressed, this, [this] { choose(garment_->currentText()); });
  connect(put_on_, &QPushButton::clicked, this, [this] { choose(garment_->currentText()); });
}

void FitPanel::build_buttons(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  row->addWidget(undo_ = new QPushButton(words::kUndo));
  row->addWidget(redo_ = new QPushButton(words::kRedo));
  row->addWidget(reset_ = new QPushButton(words::kReset));
  layout->addLayout(row);
  auto* choices = new QHBoxLayout;
  choices->addWidget(linked_ = new QCheckBox(words::kLinked));
  choices->addStretch(1);
  auto* comparing = new QLabel(words::kCompare);
  compare_ = narrow_choice();
  compare_->setToolTip(words::kCompareHelp);
  compare_->addItem(words::kAlone, words::kAfter);
  compare_->addItem(words::kAsGhost, words::kGhost);
  compare_->addItem(words::kBothSides, words::kSideBySide);
  compare_->addItem(words::kAsWipe, words::kWipe);
  compare_->addItem(words::kFading, words::kBlend);
  comparing->setBuddy(compare_);
  choices->addWidget(comparing);
  choices->addWidget(compare_, 2);
  layout->addLayout(choices);
  undo_->setEnabled(false);
  redo_->setEnabled(false);
  linked_->setChecked(true);
  auto* blending = new QHBoxLayout;
  auto* label = new QLabel(words::kBlendLabel);
  blend_ = new QSlider(Qt::Horizontal);
  blend_->setRange(0, 100);
  blend_->setValue(100);
  new WheelInFocus(blend_);
  label->setBuddy(blend_);
  blending->addWidget(label);
  blending->addWidget(blend_, 1);
  blending->addWidget(marks_ = new QCheckBox(words::kMarks));
  marks_->setChecked(true);
  marks_->setToolTip(words::kMarksHelp);
  layout->addLayout(blending);
  layout->addWidget(view_ = new ViewRow);
  connect(view_, &ViewRow::not_turned, this, [this](const QString& why) { answer(why.toStdString()); });
  connect(undo_, &QPushButton::clicked, this, &FitPanel::undo);
  connect(redo_, &QPushButton::clicked, this, &FitPanel::redo);
  connect(linked_, &QCheckBox::toggled, this, [this](bool on) { session_.link_sides(on); });
  connect(marks_, &QCheckBox::toggled, this, &FitPanel::show_marks);
  connect(reset_, &QPushButton::clicked, this, [this] {
    changed_here_ = false;
    asked_at_ = Clock::now();
    client_->reset();
  });
  connect(compare_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this] { compare(); });
  connect(blend_, &QSlider::valueChanged, this, &FitPanel::blend);
}

void FitPanel::build_export(QVBoxLayout* layout) {
  auto* whose = new QHBoxLayout;
  auto* name = new QLabel(words::kCustomer);
  customer_ = new QLineEdit;
  customer_->setMaxLength(kLongestCustomer);
  customer_->setEnabled(false);
  name->setBuddy(customer_);
  whose->addWidget(name);
  whose->addWidget(customer_, 1);
  layout->addLayout(whose);
  connect(customer_, &QLineEdit::editingFinished, this, &FitPanel::say_whose);
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(words::kFolder);
  folder_ = new QLineEdit(QDir::home().filePath("tensegric_fit_exports"));
  label->setBuddy(folder_);
  row->addWidget(label);
  row->addWidget(folder_, 1);
  row->addWidget(export_ = new QPushButton(words::kExport));
  layout->addLayout(row);
  connect(export_, &QPushButton::clicked, this, &FitPanel::start_export);
  connect(folder_, &QLineEdit::textChanged, this, [this] { Q_EMIT configChanged(); });
}

void FitPanel::build_lines() {
  empty(lines_box_);
  rows_.clear();
  auto* grid = new QGridLayout(lines_box_);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(LineRow::kName, 1);
  if (session_.now().lines.empty()) {
    grid->addWidget(new QLabel(words::kNoLines), 0, 0);
    return;
  }
  grid->addWidget(new QLabel(words::kLine), 0, LineRow::kName);
  grid->addWidget(new QLabel(words::kNeutral), 0, LineRow::kPerCent, 1, 2);
  grid->addWidget(new QLabel(words::kNow), 0, LineRow::kNow, Qt::AlignRight);
  grid->addWidget(new QLabel(words::kPull), 0, LineRow::kPull, Qt::AlignRight);
  for (const AskedLine& line : session_.now().lines) {
    auto* row = new LineRow(line.name, 1 + static_cast<int>(rows_.size()), grid);
    row->setParent(lines_box_->layout());
    connect(row, &LineRow::asked, this, &FitPanel::ask);
    connect(row, &LineRow::settled, this, [this] { session_.settle(); });
    rows_.push_back(row);
  }
  order_tabs();
  show_lines();
  show_outcome();
}

// Qt's own order is that in which things were made; lines and regions come and go.
void FitPanel::order_tabs() {
  setTabOrder(garment_, put_on_);
  QWidget* last = put_on_;
  for (LineRow* row : rows_) last = row->follow(last);
  const auto follow = [&last](QWidget* next) {
    setTabOrder(last, next);
    last = next;
  };
  for (QCheckBox* box : regions_box_->findChildren<QCheckBox*>()) follow(box);
  for (QWidget* next :
       std::initializer_list<QWidget*>{undo_, redo_, reset_, linked_, compare_, blend_, marks_})
    follow(next);
  for (QWidget* next : view_->controls()) follow(next);
  for (QWidget* next : std::initializer_list<QWidget*>{table_, customer_, folder_, export_}) follow(next);
}

void FitPanel::build_regions() {
  const Wish& wish = session_.now();
  QStringList names;
  for (const std::string& region : wish.regions()) names << text(region);
  QStringList shown;
  for (const QCheckBox* box : regions_box_->findChildren<QCheckBox*>()) shown << box->text();
  if (shown != names) {
    empty(regions_box_);
    auto* row = new QHBoxLayout(regions_box_);
    row->setContentsMargins(0, 0, 0, 0);
    if (!names.empty()) row->addWidget(new QLabel(words::kRegions));
    for (const QString& name : names) {
      auto* box = new QCheckBox(name);
      box->setToolTip(words::kRegionHelp);
      row->addWidget(box);
      connect(box, &QCheckBox::clicked, this, [this, name](bool on) {
        if (session_.switch_region(name.toStdString(), on))
          send();
        else
          answer(words::kRegionHelp);
        build_regions();
        show_lines();
      });
    }
    row->addStretch(1);
    order_tabs();
  }
  for (QCheckBox* box : regions_box_->findChildren<QCheckBox*>())
    box->setChecked(wish.off.count(box->text().toStdString()) == 0);
}

void FitPanel::show_marks(bool on) {
  for (const char* marks : {"Landmarks", "Girths"}) set_display(marks, on);
}

bool FitPanel::marks_shown() const {
  for (rviz::Display* display : displays(vis_manager_))
    if (display->subProp("Landmarks")->getValue().toBool() || display->subProp("Girths")->getValue().toBool())
      return true;
  return false;
}

void FitPanel::set_display(const char* property, const QVariant& value) {
  for (rviz::Display* display : displays(vis_manager_)) display->subProp(property)->setValue(value);
}

void FitPanel::enable_display(bool on) {
  for (rviz::Display* display : displays(vis_manager_)) display->setEnabled(on);
}

// The slider is the border of the wipe; in any other view it fades.
void FitPanel::blend(int per_cent) {
  if (compare_->currentData() != words::kWipe && compare_->currentData() != words::kBlend)
    compare_->setCurrentIndex(compare_->findData(words::kBlend));
  set_display("Blend", per_cent / 100.0);
}

// A new garment is not seen half faded.
void FitPanel::show_garment_fully() {
  if (compare_->currentData() == words::kBlend) compare_->setCurrentIndex(compare_->findData(words::kAfter));
}

void FitPanel::compare() {
  const bool wipes = compare_->currentData() == words::kWipe;
  const QSignalBlocker quiet(blend_);
  if (compare_->currentData() != words::kBlend) blend_->setValue(wipes ? 50 : 100);
  set_display("Blend", blend_->value() / 100.0);
  set_display("Show", compare_->currentData());
}

void FitPanel::start_export() {
  const QString folder = folder_->text().trimmed();
  if (folder.isEmpty()) {
    answer(words::kEmptyFolder);
    return;
  }
  if (!body_.is_worn()) {
    answer(words::kNothingToExport);
    return;
  }
  if (shows_earlier_scan()) {
    answer(words::kOldNotExported);
    return;
  }
  QString name = text(body_.scan_id() + "_" + body_.garment()).replace('/', '-');
  name += QDateTime::currentDateTime().toString("_yyyyMMdd-hhmmss");
  if (!QDir(folder).exists() && QDir().mkpath(folder))  // where that cannot be, the export says why
    QFile::setPermissions(folder, QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
  exporting_ = true;
  allow_name_and_export();
  answer("");
  client_->export_to(QDir(folder).filePath(name).toStdString(), body_.scan_id());
}

void FitPanel::say_whose() {
  if (!customer_->isModified() || customer_->text().trimmed().isEmpty() || body_.empty()) return;
  customer_->setModified(false);
  if (shows_earlier_scan()) {
    show_whose();  // as it is known, in place of what was typed
    answer(words::kOldNotNamed);
    return;
  }
  ScanLabel label;
  label.scan_id = body_.scan_id();
  label.customer = customer_->text().trimmed().toStdString();
  client_->label(label);
}

void FitPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString folder;
  if (config.mapGetString("Export folder", &folder)) folder_->setText(folder);
}

void FitPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Export folder", folder_->text());
}

}  // namespace tensegric_fit::inspect
