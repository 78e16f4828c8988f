// Words of the panel in a place of fixed height.
#include "rviz/sentence.hpp"

#include <gtest/gtest.h>

#include <QApplication>
#include <string>

namespace tensegric_fit::inspect {
namespace {

constexpr char kLong[] =
    "'chest': Presses with an estimated 9.8 kPa: wearers complain above 4.7 kPa. The skin folds into a "
    "shelf 2 cm below the right bust point: 9 cm2 are turned by up to 63 degrees. Loosen 'chest'. And 4 more "
    "places.";

class SentenceTest : public testing::Test {
 protected:
  SentenceTest() {
    qputenv("QT_QPA_PLATFORM", "offscreen");
    static int count = 1;
    static char name[] = "sentence_test", *names[] = {name, nullptr};
    static QApplication application(count, names);
  }
};

int height_of(const QString& words, const Sentence& place) {
  return place.fontMetrics()
      .boundingRect(QRect(0, 0, place.contentsRect().width(), 10000), Qt::TextWordWrap, words)
      .height();
}

TEST_F(SentenceTest, WordsThatFitAreShownWhole) {
  Sentence place(2);
  place.resize(400, place.height());
  place.say("B1: fits (48 ms).", "B1: fits (48 ms); 7 steps.");
  EXPECT_EQ(place.text().toStdString(), "B1: fits (48 ms).");
  EXPECT_EQ(place.toolTip().toStdString(), "B1: fits (48 ms); 7 steps.");
}

TEST_F(SentenceTest, WordsThatDoNotFitEndInAnEllipsis) {
  Sentence place(2, "font-weight: bold");
  place.resize(300, place.height());
  place.say(kLong);
  const QString shown = place.text();
  ASSERT_TRUE(shown.endsWith(" \u2026")) << shown.toStdString();
  EXPECT_TRUE(QString(kLong).startsWith(shown.chopped(1)));  // between two words
  EXPECT_LE(height_of(shown, place), place.height());
  EXPECT_GT(height_of(shown, place), place.height() / 2);  // both lines are used
  EXPECT_EQ(place.toolTip().toStdString(), kLong);
  EXPECT_EQ(place.accessibleName().toStdString(), kLong);
}

TEST_F(SentenceTest, AWiderPanelShowsMore) {
  Sentence place(2);
  place.resize(200, place.height());
  place.say(kLong);
  const int narrow = place.text().size();
  place.show();  // what is not shown hears of its size when it is
  place.resize(3000, place.height());
  EXPECT_LT(narrow, place.text().size());
  EXPECT_EQ(place.text().toStdString(), kLong);
}

TEST_F(SentenceTest, OneWordThatIsTooLongIsLeftOut) {
  Sentence place(1);
  place.resize(60, place.height());
  place.say(std::string(5000, 'x'));
  EXPECT_EQ(place.text().toStdString(), " \u2026");
}

TEST_F(SentenceTest, MarkupIsShownAsItCame) {
  Sentence place(1);
  place.say("<img src=x>");
  EXPECT_EQ(place.text().toStdString(), "<img src=x>");
  EXPECT_EQ(place.textFormat(), Qt::PlainText);
}

}  // namespace
}  // namespace tensegric_fit::inspect
