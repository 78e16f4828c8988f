/// The page of an export, also as a browser shows it.
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "inspect/warning_words.hpp"
#include "ros_exported_scan.hpp"

namespace tensegric_fit::node {
namespace {

class ExportPage : public ExportFitTest {};

TEST_F(ExportPage, ThePageNeedsNothingElseAndTakesNamesAsTheyAre) {
  export_fit(scan_, root_ / "one", kWhole);
  const std::string page = text_of(root_ / "one" / "fit.html");
  EXPECT_NE(page.find("<th scope=\"row\">bust girth, cm</th><td>94.2</td><td>84.8</td><td>-9.4</td>"),
            std::string::npos);
  EXPECT_NE(page.find("<th scope=\"row\">lift of the bust, mm</th><td></td><td></td><td>+0</td>"),
            std::string::npos);
  EXPECT_NE(page.find("<th scope=\"row\">chest</th><td>40.0</td><td>36.0</td><td>10.0 %</td>"),
            std::string::npos);
  EXPECT_NE(page.find("<button data-loop=\"bust\""), std::string::npos);
  EXPECT_EQ(page.find("data-loop=\"underbust\""), std::string::npos) << "its tape is not known";
  EXPECT_NE(page.find("<th scope=\"row\">underbust girth, cm*</th>"), std::string::npos) << "it is uncertain";
  EXPECT_EQ(page.find("bra size"), std::string::npos) << "and so would a size be";
  EXPECT_NE(page.find("hair, &lt;b&gt;long&lt;/b&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("<link"), std::string::npos);
  std::string html = page;
  for (std::size_t at = html.find("<script"); at != std::string::npos; at = html.find("<script"))
    html.erase(at, html.find("</script>", at) - at);
  std::size_t pictures = 0;
  for (std::size_t at = html.find("src="); at != std::string::npos;
       at = html.find("src=", at + 1), ++pictures)
    EXPECT_EQ(html.compare(at, 27, "src=\"data:image/png;base64,"), 0);
  EXPECT_EQ(pictures, 3u);
  EXPECT_EQ(html.find("href="), std::string::npos);
  EXPECT_LT(page.size(), 8'000'000u);
  EXPECT_EQ(text_of(root_ / "one" / "measurements.csv"),
            "kind,name,before_mm,after_mm,confidence,half_width_mm,reason\r\n"
            "height,bust,1200.0,1200.0,0.90,,\r\n"
            "height,stature,1700.0,1700.0,1.00,,\r\n"
            "girth,bust,942.0,847.8,0.90,4.0,\r\n"
            "girth,underbust,750.0,,0.40,,\"hair, <b>long</b>\"\r\n");
}

TEST_F(ExportPage, ASizeIsNamedWhereTheGirthsAreSure) {
  const auto landmarks = boost::make_shared<Landmarks>(*scan_.landmarks);
  for (Measure& girth : landmarks->girths) girth.confidence = 0.9F;
  scan_.landmarks = landmarks;
  export_fit(scan_, root_ / "one", kWhole);
  EXPECT_NE(text_of(root_ / "one" / "fit.html").find("<b>75D</b>"), std::string::npos);
}

TEST_F(ExportPage, WhatIsNoSmoothSkinOrWasNotScannedStandsAtItsHead) {
  geometry::FitWarning shelf, made_up, stretched;
  shelf.code = geometry::warning::kShelf;
  made_up.code = geometry::notice::kNotScanned;
  stretched.code = geometry::notice::kOverStretched;  // on the pictures
  made_up.line = "<chest>";
  made_up.value = 0.68;
  scan_.warnings = {shelf, made_up, stretched};
  export_fit(scan_, root_ / "one", kWhole);
  const std::string page = text_of(root_ / "one" / "fit.html");
  const std::size_t first = page.find("bust girth, cm");
  EXPECT_LT(page.find("The skin folds into a shelf"), first);
  EXPECT_LT(page.find("The scan did not see the skin under '&lt;chest&gt;' (68 % of its length)"), first);
  EXPECT_EQ(page.find(inspect::words::warning(stretched, {})), std::string::npos);
}

TEST_F(ExportPage, TheLiftIsRoundedAlone) {
  const auto landmarks = boost::make_shared<Landmarks>(*scan_.landmarks);
  for (Measure& height : landmarks->heights)
    if (height.name == "bust") height.value = 1.2004;  // 0.2 mm more are 1201 in whole mm
  const auto lifted = boost::make_shared<DeformedMesh>(*scan_.deformed);
  for (std::size_t z = 2; z < lifted->vertices.size(); z += 3) lifted->vertices[z] += 0.0002F;
  scan_.landmarks = landmarks;
  scan_.deformed = lifted;
  export_fit(scan_, root_ / "one", kWhole);
  EXPECT_NE(
      text_of(root_ / "one" / "fit.html").find("lift of the bust, mm</th><td></td><td></td><td>+0</td>"),
      std::string::npos);
}

TEST_F(ExportPage, WhatOfTheBodyIsMissingStandsOnPageAndPictures) {
  export_fit(scan_, root_ / "whole", kWhole);
  const auto landmarks = boost::make_shared<Landmarks>(*scan_.landmarks);
  landmarks->missing.emplace_back();
  landmarks->missing.back().name = "forearm_L";
  landmarks->missing.back().reason = "none of <it>, nor is hand_L";
  scan_.landmarks = landmarks;
  export_fit(scan_, root_ / "without", kWhole);
  const std::string words = "Missing: left forearm; none of &lt;it&gt;, nor is left hand.";
  EXPECT_NE(text_of(root_ / "without" / "fit.html").find(words), std::string::npos);
  EXPECT_EQ(text_of(root_ / "whole" / "fit.html").find("Missing: "), std::string::npos);
  for (const char* name : {"front.png", "side.png", "distortion.png"})
    EXPECT_GT(cv::imread((root_ / "without" / name).string()).rows,
              cv::imread((root_ / "whole" / name).string()).rows)
        << name;
}

const std::string kDrive =
    "timeout 300 /usr/bin/python3 -B " TENSEGRIC_FIT_SOURCE_DIR "/tests/page/drive_page.py";

/// Pictures of the body in the page as headless Chromium shows it, opened at each of these addresses.
std::vector<cv::Mat> shown(const fs::path& page, const std::vector<std::string>& addresses) {
  const fs::path folder = page.parent_path() / "shown";
  std::string command = kDrive + " '" + page.string() + "' --pictures '" + folder.string() + "'";
  for (const std::string& address : addresses) command += " --at '" + address + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < addresses.size(); ++i)
    pictures.push_back(cv::imread((folder / (std::to_string(i) + ".png")).string()));
  return pictures;
}

/// Share of the pixels that differ clearly.
double difference(const cv::Mat& a, const cv::Mat& b) {
  if (a.empty() || a.size() != b.size()) return -1;
  cv::Mat apart;
  cv::absdiff(a, b, apart);
  int clear = 0;
  for (int y = 0; y < apart.rows; ++y)
    for (int x = 0; x < apart.cols; ++x) {
      const auto& p = apart.at<cv::Vec3b>(y, x);
      clear += std::max({p[0], p[1], p[2]}) > 20;
    }
  return static_cast<double>(clear) / (a.rows * a.cols);
}

TEST_F(ExportPage, TheBodyInThePageTurnsAndChanges) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  export_fit(scan_, root_ / "one", kWhole);
  const std::vector<cv::Mat> body =
      shown(root_ / "one" / "fit.html",
            {"share=100", "share=100", "share=0", "share=100&loop=bust", "share=100&beside=1"});
  const cv::Mat& worn = body[0];
  ASSERT_FALSE(worn.empty());
  EXPECT_EQ(difference(worn, body[1]), 0) << "the same picture twice";
  EXPECT_GT(difference(worn, body[2]), 0.02) << "the trunk is wider, its colour another";
  EXPECT_GT(difference(worn, body[3]), 0.001) << "the tape";
  EXPECT_GT(difference(worn, body[4]), 0.02);
}

TEST_F(ExportPage, ThePageIsUsedByKeyboardAndReadByAScreenReader) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  const auto fit = boost::make_shared<FitState>(*scan_.fit);
  LineResult& line = fit->lines[0];
  for (int i = -10; i <= 10; ++i)  // over the front, so that the tube looks different from each side
    for (const auto& [course, radius] : {std::pair(&line.course_at_rest, 0.15), {&line.course, 0.135}})
      for (const double value : {radius * std::cos(0.1 * i), radius * std::sin(0.1 * i), 1.2})
        course->push_back(value);
  scan_.fit = fit;
  export_fit(scan_, root_ / "one", kWhole);
  const std::string drive = kDrive + " '" + (root_ / "one" / "fit.html").string() + "'";
  EXPECT_EQ(std::system(drive.c_str()), 0) << drive;
}

}  // namespace
}  // namespace tensegric_fit::node
