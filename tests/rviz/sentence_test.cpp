// Words of the panel in a place of fixed height.
#include "rviz/sentence.hpp"

#include <gtest/gtest.h>

#include <QApplication>
#include <QImage>
#include <set>
#include <string>

#include "inspect/colour_scale.hpp"
#include "inspect/panel_words.hpp"
#include "inspect/pointing.hpp"
#include "inspect/words.hpp"
#include "rviz/girth_table.hpp"

namespace tensegric_fit::inspect {

QImage legend_picture(const ColourScale& scale, const std::string& sentence);  // its header needs Ogre

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

TEST_F(SentenceTest, AnAnswerToAClickIsReadWholeOnTheLegend) {
  const ColourScale scale = fixed_scale(ColourBy::distortion);
  const auto columns_with_ink = [&](const std::string& words) {
    const QImage with = legend_picture(scale, words), without = legend_picture(scale, "");
    std::set<int> columns;
    for (int x = 0; x < with.width(); ++x)
      for (int y = 0; y < with.height(); ++y)
        if (with.pixel(x, y) != without.pixel(x, y)) columns.insert(x);
    return columns;
  };
  std::string words = words::pointed(scale.by, 0.72, spoken("gluteal_fold_R"), 0.123);  // the longest name
  for (int more = 0; more < 2; ++more, words += " " + words + words) {
    const std::set<int> columns = columns_with_ink(words);
    ASSERT_FALSE(columns.empty());
    EXPECT_GT(*columns.begin(), 12) << words;
    EXPECT_LT(*columns.rbegin(), 400 - 12) << words;
  }
}

TEST_F(SentenceTest, UnsureGirthsAreMarkedAndHaveNoSize) {
  const auto shown = [](double confidence, bool is_worn) {
    geometry::BodyMeasures measures;
    measures.girths = {{"bust", 0.93, confidence, "much was unseen"}, {"underbust", 0.76, 1, ""}};
    const geometry::TriangleMesh none;
    GirthTable table;
    table.show_measures(measures, {none, none.vertices}, is_worn);
    std::vector<std::string> cells;
    for (int row = 0; row < table.rowCount(); ++row)
      for (int column : {0, 1, 2}) cells.push_back(table.item(row, column)->text().toStdString());
    cells.push_back(table.item(1, 0)->toolTip().toStdString());
    return cells;
  };
  const std::vector<std::string> sure = shown(0.9, true), unsure = shown(0.4, false);
  ASSERT_EQ(sure.size(), 10u);
  ASSERT_EQ(unsure.size(), 10u);
  EXPECT_NE(sure[1], words::kNoSize);
  EXPECT_EQ(unsure[1], words::kNoSize);
  EXPECT_EQ(unsure[3], sure[3] + "*");
  EXPECT_EQ(unsure[9], "much was unseen");
  EXPECT_EQ(sure[5], words::kNoSize) << "worn, and not known";
  EXPECT_EQ(unsure[5], "") << "nothing is worn";
}

TEST_F(SentenceTest, MarkupIsShownAsItCame) {
  Sentence place(1);
  place.say("<img src=x>");
  EXPECT_EQ(place.text().toStdString(), "<img src=x>");
  EXPECT_EQ(place.textFormat(), Qt::PlainText);
}

}  // namespace
}  // namespace tensegric_fit::inspect
