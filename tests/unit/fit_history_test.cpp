/// A customer's visits, found in the folders that exports and `fit` wrote.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "fit/history.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;

class HistoryTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(root_); }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& folder, const std::string& name, const std::string& text) const {
    fs::create_directories(root_ / folder);
    std::ofstream(root_ / folder / name) << text;
    geometry::TriangleMesh body;  // a tetrahedron as high as a person
    body.vertices = {{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 1.7}};
    body.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    geometry::write_ply_mesh((root_ / folder / "body.ply").string(), body);
  }

  static std::string exported(const std::string& stamp, const std::string& customer, double bust,
                              double half) {
    return R"({"format": "tensegric_fit/fit", "scan": {"scan_id": ")" + stamp +
           R"(-00000001", "customer": ")" + customer +
           R"(", "source": "a<b.ply", "body_from_scan": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},
           "garment": {"name": "B1", "lines": [{"name": "chest", "ratio": 0.95}]},
           "body": {"heights": [], "girths": [{"name": "bust", "before_mm": )" +
           std::to_string(bust) + R"(, "after_mm": 880, "half_width_mm": )" + std::to_string(half) + "}]}}";
  }

  const fs::path root_ = fs::temp_directory_path() / ("history_test." + std::to_string(getpid()));
};

TEST_F(HistoryTest, AStampThatIsNoDateIsNotTheDay) {
  for (const char* stamp : {"1e300", "inf", "nan", "-5"}) {
    write("odd", "fit.json", exported(stamp, "4711", 900, 5));
    const std::vector<Visit> visits = find_visits({root_}, "4711");
    ASSERT_EQ(visits.size(), 1u) << stamp;
    EXPECT_EQ(visits[0].day.substr(0, 2), "20") << stamp << ": not when the document was written";
  }
}

TEST_F(HistoryTest, VisitsAreFoundByCustomerTheOldestFirst) {
  write("2026/b", "fit.json", exported("1790000000.5", "4711", 900, 5));
  write("2025/a", "fit.json", exported("1760000000.5", "4711", 920, 5));
  write("2025/c", "fit.json", exported("1760000000.5", "0815", 950, 5));
  write("2025/d", "fit.json", "{\"format\": \"another program's\"}");
  write("2025/e", "report.json", "{\"status\": \"refused\"}");
  write("2025/f", "report.json", "[");
  constexpr std::size_t kDeep = 1 << 20;
  write("2025/g", "report.json",
        R"({"status": "ok", "scan": )" + std::string(kDeep, '[') + std::string(kDeep, ']') + "}");
  const std::vector<Visit> visits = find_visits({root_}, "4711");
  ASSERT_EQ(visits.size(), 2u);
  EXPECT_EQ(visits[0].folder.filename(), "a");
  EXPECT_EQ(visits[0].day, "2025-10-09");
  EXPECT_EQ(visits[0].garment, "B1");
  EXPECT_EQ(visits[0].lines.at("chest"), 0.95);
  EXPECT_EQ(visits[0].girths.at("bust").before, 0.92);
  EXPECT_EQ(*visits[0].girths.at("bust").after, 0.88);
  EXPECT_EQ(find_visits({root_}, "").size(), 3u);
  EXPECT_EQ(find_visits({root_}, " 4711\t").size(), find_visits({root_}, "4711").size());
  EXPECT_EQ(find_visits({root_}, " ").size(), 0u) << "blanks are not everybody";
  EXPECT_EQ(find_visits({root_}, "47").size(), 0u) << "part of an id is another id";
  EXPECT_NE(customers_text(find_visits({root_}, "")).find("4711"), std::string::npos);
  EXPECT_THROW(find_visits({root_ / "nowhere"}, ""), geometry::Refusal);
}

TEST_F(HistoryTest, AVisitCountsOnceAndAnExportThatWasNeverFinishedNot) {
  write("2026/b", "fit.json", exported("1790000000.5", "4711", 900, 5));
  write("2026/.c.unfinished", "fit.json", exported("1790000001.5", "4711", 900, 5));
  fs::create_directory_symlink(root_ / "2026" / "b", root_ / "link");
  EXPECT_EQ(find_visits({root_, root_ / "2026", (root_ / "2026" / "b").string() + "/"}, "4711").size(), 1u);
}

TEST_F(HistoryTest, AChangeIsBeyondDoubtWhereItIsMoreThanTwoScansLeaveOpen) {
  write("a", "fit.json", exported("1760000000.5", "4711", 920, 5));
  write("b", "fit.json", exported("1790000000.5", "4711", 928, 6));  // 7.8 mm are open
  write("c", "fit.json", exported("1790000001.5", "4711", 927, 6));
  write("d", "fit.json", exported("1790000002.5", "4711", 999, 0));  // nobody says how sure
  const std::vector<Visit> visits = find_visits({root_}, "4711");
  const auto change = [&](std::size_t to) { return changes(visits[0], visits[to]).at(0); };
  EXPECT_NEAR(change(1).half_width, std::hypot(0.005, 0.006), 1e-12);
  EXPECT_TRUE(change(1).beyond_doubt());
  EXPECT_FALSE(change(2).beyond_doubt());
  EXPECT_FALSE(change(3).beyond_doubt());
  EXPECT_NE(visits_text(visits, 0, 1).find("changed"), std::string::npos);
  EXPECT_EQ(visits_text(visits, 0, 2).find("changed"), std::string::npos);
}

TEST_F(HistoryTest, ReportsOfFitAreVisitsToo) {
  write("a", "report.json", R"({"status": "ok", "garment": "B2",
    "scan": {"file": "/in/scan.ply", "customer": "4711 ", "body_from_scan": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},
    "girths": {"bust": 0.9}, "heights": {"bust": 1.2}, "confidence": {"girths": {"bust": {"half_width": 0.004}}},
    "lines": [{"name": "cup", "ratio": 0.9}]})");
  const std::optional<Visit> visit = read_visit(root_ / "a");
  ASSERT_TRUE(visit);
  EXPECT_EQ(visit->customer, "4711");
  EXPECT_EQ(visit->garment, "B2");
  EXPECT_EQ(visit->source, "scan.ply");
  EXPECT_EQ(visit->girths.at("bust").half_width, 0.004);
  EXPECT_EQ(visit->heights.at("bust").half_width, 0);
}

TEST_F(HistoryTest, WhatIsNoDocumentOfOursIsNotRead) {
  const std::string document = exported("1760000000.5", "4711", 920, 5);
  write("own", "fit.json", document);
  fs::create_directories(root_ / "link");
  fs::create_symlink(root_ / "own" / "fit.json", root_ / "link" / "fit.json");
  EXPECT_TRUE(read_visit(root_ / "link"));
  write("large", "fit.json", document + std::string(16 << 20, ' '));
  EXPECT_FALSE(read_visit(root_ / "large"));
  fs::create_directories(root_ / "pipe");
  ASSERT_EQ(mkfifo((root_ / "pipe" / "report.json").c_str(), 0600), 0);
  EXPECT_FALSE(read_visit(root_ / "pipe"));
}

TEST_F(HistoryTest, ABodyWithoutItsHeadLiesWhereItLayWithIt) {
  geometry::TriangleMesh body;  // leans, so that it lies elsewhere where its trunk is taken for lower
  for (const double height : {0.0, 0.9, 1.3, 1.4}) {
    const double lean = height > 1 ? 0.2 : 0;
    body.vertices.insert(body.vertices.end(),
                         {{lean, lean, height}, {lean + 0.3, lean, height}, {lean, lean + 0.3, height}});
  }
  for (int ring = 0; ring < 9; ring += 3)
    for (int k = 0; k < 3; ++k) {
      const int a = ring + k, b = ring + (k + 1) % 3;
      body.triangles.insert(body.triangles.end(), {{a, b, b + 3}, {a, b + 3, a + 3}});
    }
  geometry::TriangleMesh whole = body;
  whole.vertices.emplace_back(0, 0, 1.7);  // the crown, which no triangle shows
  std::string document = exported("1760000000.5", "4711", 920, 5);
  const std::string heights = "\"heights\": [";
  document.insert(document.find(heights) + heights.size(),
                  R"({"name": "stature", "before_mm": 1700, "after_mm": null})");
  std::vector<Visit> visits;
  for (const auto& [folder, mesh] : {std::pair("a", &whole), {"b", &whole}, {"c", &body}}) {
    write(folder, "fit.json", document);
    geometry::write_ply_mesh((root_ / folder / "body.ply").string(), *mesh);
    visits.push_back(read_visit(root_ / folder).value());
  }
  const auto picture = [&](std::size_t to) {
    const std::string page = visits_page(visits, 0, to, root_ / "page.html");
    const std::size_t begin = page.find("base64,");
    return page.substr(begin, page.find('"', begin) - begin);
  };
  EXPECT_TRUE(picture(1) == picture(2));
}

TEST_F(HistoryTest, ThePageIsWholeSafeAndLinksEachVisit) {
  write("first visit", "fit.json", exported("1760000000.5", "<i>", 920, 5));
  write("first visit", "fit.html", "her page");
  write("second", "fit.json", exported("1790000000.5", "<i>", 940, 5));
  const std::vector<Visit> visits = find_visits({root_}, "<i>");
  const std::string page = visits_page(visits, 0, 1, root_ / "page.html");
  EXPECT_NE(page.find("href=\"first%20visit/fit.html\""), std::string::npos);
  EXPECT_NE(page.find("href=\"second/\""), std::string::npos);
  EXPECT_NE(page.find("<b>+2.0</b>"), std::string::npos);
  EXPECT_NE(page.find("a&lt;b.ply"), std::string::npos);
  EXPECT_EQ(page.find("<i>"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "needs a network";
  fs::remove(root_ / "second" / "body.ply");
  EXPECT_THROW(visits_page(visits, 0, 1, root_ / "page.html"), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::fit
