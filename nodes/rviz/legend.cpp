#include "rviz/legend.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>
#include <Overlay/OgrePanelOverlayElement.h>

#include <QPainter>

#include "inspect/words.hpp"
#include "rviz/qt_text.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kWidth = 400, kHeight = 124, kMargin = 12, kBarTop = 26, kBarHeight = 16;  // pixels
constexpr int kPaperOpacity = 215;

std::string next_legend_name() {
  static int count = 0;
  return "tensegric_fit_legend_" + std::to_string(count++);
}

}  // namespace

QImage legend_picture(const ColourScale& scale, const std::string& sentence) {
  QImage picture(kWidth, kHeight, QImage::Format_ARGB32);
  picture.fill(QColor(255, 255, 255, kPaperOpacity));
  QPainter painter(&picture);
  QFont font("sans");
  font.setPixelSize(13);
  painter.setFont(font);
  painter.setRenderHint(QPainter::Antialiasing);

  painter.setPen(QColor(40, 40, 40));
  const int bar = kWidth - 2 * kMargin;
  // On two lines where one is too short; the first may end a word before the margin.
  constexpr int kLongestWord = 110;
  const QString shown =
      painter.fontMetrics().elidedText(text(sentence), Qt::ElideRight, 2 * bar - kLongestWord);
  painter.drawText(QRect(kMargin, kHeight - 38, bar, 36), Qt::AlignCenter | Qt::TextWordWrap, shown);
  if (scale.by == ColourBy::plain) return picture;
  const double low = scale.low, high = scale.high;
  for (int x = 0; x < bar; ++x) {
    const Colour c = colour_of(scale, low + (high - low) * x / (bar - 1));
    painter.fillRect(kMargin + x, kBarTop, 1, kBarHeight, QColor(c[0], c[1], c[2]));
  }
  const QRect above(kMargin, 4, bar, kBarTop - 6), below(kMargin, kBarTop + kBarHeight + 3, bar, 20);
  const words::ScaleWords& said = words::scale_words(scale.by);
  painter.drawText(above, Qt::AlignLeft | Qt::AlignVCenter, said.low);
  painter.drawText(above, Qt::AlignHCenter | Qt::AlignVCenter, said.title);
  painter.drawText(above, Qt::AlignRight | Qt::AlignVCenter, said.high);
  painter.drawText(below, Qt::AlignLeft | Qt::AlignVCenter, text(words_of(scale.by, low)));
  painter.drawText(below, Qt::AlignHCenter | Qt::AlignVCenter, text(words_of(scale.by, (low + high) / 2)));
  painter.drawText(below, Qt::AlignRight | Qt::AlignVCenter, text(words_of(scale.by, high)));
  if (scale.by != ColourBy::distortion) return picture;
  const Colour unheld = with_unheld({kNeutral}, {0})[0];
  const int row = below.bottom() + 3;
  painter.fillRect(kMargin, row, 2 * kBarHeight, kBarHeight, QColor(unheld[0], unheld[1], unheld[2]));
  painter.drawText(QRect(kMargin + 2 * kBarHeight + 6, row, bar, kBarHeight),
                   Qt::AlignLeft | Qt::AlignVCenter, words::kUnheldLegend);
  return picture;
}

Legend::Legend()
    : name_(next_legend_name()),
      overlay_(Ogre::OverlayManager::getSingleton().create(name_)),
      panel_(static_cast<Ogre::PanelOverlayElement*>(
          Ogre::OverlayManager::getSingleton().createOverlayElement("Panel", name_ + "_panel"))),
      material_(Ogre::MaterialManager::getSingleton().create(name_, Ogre::RGN_DEFAULT)),
      texture_(Ogre::TextureManager::getSingleton().createManual(name_, Ogre::RGN_DEFAULT, Ogre::TEX_TYPE_2D,
                                                                 kWidth, kHeight, 0, Ogre::PF_A8R8G8B8)) {
  Ogre::Pass* pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass->createTextureUnitState(name_)->setTextureFiltering(Ogre::TFO_NONE);

  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setMaterialName(name_, Ogre::RGN_DEFAULT);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  panel_->setPosition(kMargin, -kHeight - kMargin);
  panel_->setDimensions(kWidth, kHeight);
  overlay_->add2D(panel_);
}

Legend::~Legend() {
  overlay_->remove2D(panel_);
  Ogre::OverlayManager::getSingleton().destroyOverlayElement(panel_);
  Ogre::OverlayManager::getSingleton().destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(material_);
  Ogre::TextureManager::getSingleton().remove(texture_);
}

void Legend::set(const ColourScale& scale, const std::string& sentence) {
  const QImage picture = legend_picture(scale, sentence);
  const Ogre::PixelBox pixels(kWidth, kHeight, 1, Ogre::PF_A8R8G8B8,
                              const_cast<uchar*>(picture.constBits()));  // only read
  texture_->getBuffer()->blitFromMemory(pixels);
}

void Legend::show(bool visible) {
  if (visible)
    overlay_->show();
  else
    overlay_->hide();
}

}  // namespace tensegric_fit::inspect
