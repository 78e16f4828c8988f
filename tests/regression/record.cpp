#include "record.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "bag_runner.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "golden_shape.hpp"
#include "ros/bag_check.hpp"
#include "stamp.hpp"
#include "tensegric/fit_messages.hpp"
#include "yaml_values.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;
using sensor_msgs::PointCloud2;

/// What a bag has for a case.
struct Input {
  std::vector<std::pair<std::string, PointCloud2::ConstPtr>> clouds;  ///< topic; one scan, or one per sensor
  std::vector<std::string> sensors;                   ///< topics, in their order; empty: one scan
  std::vector<tf2_msgs::TFMessage::ConstPtr> places;  ///< of the sensors
  std::vector<Garment> garments;                      ///< in their order
};

bool is_scan_topic(const std::string& topic) {
  return chain_topic(topic) == "scan/points";
}

std::vector<std::uint8_t> bytes_of(Garment garment) {
  garment.header = {};
  garment.name.clear();
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(garment));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, garment);
  return bytes;
}

std::string plain_name(const Garment& garment) {
  return garment.name.substr(0, garment.name.find(" #"));
}

bool is_same(const Garment& one, const Garment& other) {
  return plain_name(one) == plain_name(other) && bytes_of(one) == bytes_of(other);
}

/// What comes in a bag, each with its number there.
struct Content {
  std::map<std::string, std::vector<std::pair<std::size_t, PointCloud2::ConstPtr>>> clouds;  ///< by topic
  std::vector<std::pair<std::size_t, Garment>> garments;
  std::vector<tf2_msgs::TFMessage::ConstPtr> places;
  std::string scan_topic;
};

Content content_of(const std::string& path) {
  Content content;
  std::size_t number = 0;
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag);
  if (const std::set<std::string> booths = node::booths_in(view); !booths.empty())
    throw Refusal(geometry::refusal::kBrokenFile,
                  fmt::format("{}: is of more than one booth: {}; check_bag says how to take one out", path,
                              fmt::join(booths, ", ")));
  for (const rosbag::MessageInstance& message : view) {
    ++number;
    if (const auto cloud = message.instantiate<PointCloud2>()) {
      content.clouds[message.getTopic()].emplace_back(number, cloud);
      if (is_scan_topic(message.getTopic())) content.scan_topic = message.getTopic();
    }
    if (const auto places = message.instantiate<tf2_msgs::TFMessage>()) content.places.push_back(places);
    if (const auto garment = message.instantiate<Garment>()) content.garments.emplace_back(number, *garment);
  }
  return content;
}

/// What is worn on the scan that is whole with message `begin`: what was put on last before it, and all until
/// the next scan is whole with message `end`. The same once more is no other garment.
std::vector<Garment> garments_between(std::size_t begin, std::size_t end, const Content& content) {
  std::vector<Garment> garments;
  for (const auto& [number, garment] : content.garments) {
    if (number > end) break;
    if (number < begin) garments.clear();
    if (garments.empty() || !is_same(garments.back(), garment)) garments.push_back(garment);
  }
  return garments;
}

Input read_input(const RecordRequest& request) {
  const Content content = read_bag(request.bag, [&request] { return content_of(request.bag); });
  if (content.clouds.empty())
    throw Refusal(geometry::refusal::kBrokenFile, request.bag + ": has no sensor_msgs/PointCloud2");
  const bool sensors = content.scan_topic.empty() && content.clouds.size() > 1;
  std::vector<std::string> topics;
  if (sensors)
    for (const auto& topic : content.clouds) topics.push_back(topic.first);
  else
    topics = {content.scan_topic.empty() ? content.clouds.begin()->first : content.scan_topic};
  std::sort(topics.begin(), topics.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;  // 10 behind 9
  });
  Input input;
  const auto wanted = static_cast<std::size_t>(request.scan);
  std::size_t begin = 0, end = 0;
  for (const std::string& topic : topics) {
    const auto& clouds = content.clouds.at(topic);
    if (clouds.size() < wanted)
      throw Refusal(geometry::refusal::kBrokenFile, fmt::format("{}: has {} clouds on '{}', not {}",
                                                                request.bag, clouds.size(), topic, wanted));
    const std::string plain = topic.front() == '/' ? topic.substr(1) : topic;
    if (sensors) input.sensors.push_back(plain);
    input.clouds.emplace_back(sensors ? "/" + plain : "/scan/points", clouds[wanted - 1].second);
    begin = std::max(begin, clouds[wanted - 1].first);
    end = std::max(end, clouds.size() > wanted ? clouds[wanted].first : std::string::npos);
  }
  if (sensors) input.places = content.places;
  input.garments = garments_between(begin, end, content);
  return input;
}

node::GarmentRequest shipped_garment(const std::string& name) {
  return {tensegric::take_garment(name, geometry::shipped_folder("garments")), ""};
}

// How a case file asks for it; empty where it is no shipped garment, whatever its name.
std::string words_for(const Garment& garment) {
  const std::string name = plain_name(garment);
  std::string ratios;
  try {
    node::GarmentRequest shipped = shipped_garment(name);
    for (const GarmentLine& line : garment.lines) {
      const auto same = std::find_if(shipped.garment.lines.begin(), shipped.garment.lines.end(),
                                     [&](const auto& other) { return other.name == line.name; });
      if (same == shipped.garment.lines.end()) return "";
      if (same->ratio != line.ratio)
        ratios += fmt::format("{}{}: {}", ratios.empty() ? "" : ", ", line.name, line.ratio);
      same->ratio = line.ratio;
    }
    if (bytes_of(node::to_message({}, shipped)) != bytes_of(garment)) return "";
  } catch (const Refusal&) {
    return "";
  }
  return ratios.empty() ? name : fmt::format("{{name: {}, ratios: {{{}}}}}", name, ratios);
}

std::string scene_of(const std::vector<Garment>& garments) {
  if (garments.empty()) return "measure";
  std::set<std::string> regions;
  for (const Garment& garment : garments) regions.insert(garment.regions.begin(), garment.regions.end());
  return fmt::format("{}", fmt::join(regions, "+"));
}

void take_wanted(const RecordRequest& request, Input& input) {
  if (request.garments.empty()) return;
  input.garments.clear();
  if (request.garments == std::vector<std::string>{"none"}) return;
  for (const std::string& name : request.garments)
    input.garments.push_back(node::to_message({}, shipped_garment(name)));
}

void write_bag(const fs::path& path, const Input& input, bool with_garments) {
  fs::create_directories(path.parent_path());
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(rosbag::compression::BZ2);
  const ros::Time time(1000000000, 0);  // any fixed time: the same case, the same bytes
  // What has the same time is read by topics, in no order of ours: places come before the clouds they are of.
  for (const auto& places : input.places) bag.write("/tf_static", time - ros::Duration(1), *places);
  for (std::size_t i = 0; i < input.clouds.size(); ++i)
    bag.write(input.clouds[i].first, time + ros::Duration(0.001 * static_cast<double>(i)),
              *input.clouds[i].second);
  if (!with_garments) return;
  for (std::size_t i = 0; i < input.garments.size(); ++i) {
    Garment garment = input.garments[i];
    garment.name = plain_name(garment) + (i == 0 ? "" : fmt::format(" #{}", i + 1));
    bag.write("/garment", time + ros::Duration(i == 0 ? -1.0 : static_cast<double>(i)), garment);
  }
}

std::array<fs::path, 3> files_of(const RecordRequest& request) {
  const fs::path cases = request.cases;
  return {cases / (request.name + ".yaml"), cases / "bags" / (request.name + ".bag"),
          cases / "shapes" / (request.name + ".yaml")};
}

/// The files of a case that is being recorded, none of which was there; they are removed where it fails.
class Unfinished {
 public:
  explicit Unfinished(const RecordRequest& request) : files_(files_of(request)) {}
  ~Unfinished() {
    std::error_code missing;
    if (!done_)
      for (const fs::path& file : files_) fs::remove(file, missing);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  void done() { done_ = true; }

 private:
  const std::array<fs::path, 3> files_;
  bool done_ = false;
};

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

/// How nearly a metric of a kind is to hold, and why.
struct Kind {
  std::string begin, end;   ///< of the metric's name, behind the garment's number
  double tolerance, share;  ///< the larger of both: of the metric's unit, of its value
  std::string reason;
};

const Kind& kind_of(const std::string& metric) {
  static const Kind kinds[] = {
      {"landmark/", "", 0.001, 0, "a millimetre; the same on every machine but for rounding"},
      {"height/", "", 0.001, 0, "a millimetre"},
      {"girth/", "", 0.001, 0, "a millimetre"},
      {"body/triangles", "", 0, 0.02, "2 %"},
      {"body/volume_change", "", 0.0005, 0, "only the control volume is held exactly"},
      {"body/volume", "", 0, 0.002, "0.2 % of the body"},
      {"body/filled", "", 0.01, 0, "a hundredth of the skin"},
      {"body/largest_move", "", 0.0003, 0, "0.3 mm can be felt"},
      {"body/other_roundings", "", 2, 0, "two may lie on the edge between two single numbers"},
      {"fit/iterations", "", 3, 0, "half as many again cost half as much time again"},
      {"fit/residual", "", 1e-4, 0, "how near to balance the solver stops"},
      {"line/", "/ratio", 0.0005, 0, "half a millimetre of a metre"},
      {"line/", "/tension", 0, 0.02, "2 % stiffer parts pull 2 % more"},
      {"region/", "/volume", 0, 0.01, "1 % of the control volume"},
      {"region/", "/volume_error", 1e-6, 0, "the control volume is held exactly"},
      {"region/", "/body_volume_error", 0.0005, 0, "only the control volume is held exactly"},
      {"distortion/", "", 0.01, 0, "1 % of skin area"},
      {"", "", 0, 0.01, "1 %"}};
  const std::size_t slash = metric.find('/');
  const bool numbered = slash != std::string::npos &&
                        std::all_of(metric.begin(), metric.begin() + static_cast<long>(slash), ::isdigit);
  const std::string name = numbered ? metric.substr(slash + 1) : metric;
  return *std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& kind) {
    return name.rfind(kind.begin, 0) == 0 && name.size() >= kind.end.size() &&
           name.compare(name.size() - kind.end.size(), kind.end.size(), kind.end) == 0;
  });
}

}  // namespace

std::string metric_lines(const Metrics& metrics) {
  std::string lines;
  for (const auto& [metric, value] : metrics) {
    if (metric.rfind("time/", 0) == 0 || metric.rfind("memory/", 0) == 0) continue;
    if (const double* number = std::get_if<double>(&value)) {
      const Kind& kind = kind_of(metric);
      lines += fmt::format("  {}: {{golden: {}, tolerance: {:g}, reason: \"{}\"}}\n", metric, to_text(value),
                           std::max(kind.tolerance, kind.share * std::abs(*number)), kind.reason);
    } else {
      lines += fmt::format("  {}: {{golden: {}, reason: as recorded}}\n", metric, to_text(value));
    }
  }
  return lines;
}

void write_case_input(const RecordRequest& request) {
  const auto bad = [](char letter) {
    return !std::isalnum(static_cast<unsigned char>(letter)) && letter != '_' && letter != '-';
  };
  if (request.name.empty() || std::any_of(request.name.begin(), request.name.end(), bad))
    throw Refusal(kBadCase, "'" + request.name + "' is no name for a case: letters, digits, _ and - only");
  for (const fs::path& file : files_of(request))  // the bag that is recorded from may lie there, too
    if (fs::exists(file)) throw Refusal(kBadCase, file.string() + " is there already");
  const fs::path file = files_of(request).front();
  Input input = read_input(request);
  take_wanted(request, input);
  std::vector<std::string> words;
  for (const Garment& garment : input.garments) words.push_back(words_for(garment));
  const bool shipped =
      std::none_of(words.begin(), words.end(), [](const std::string& w) { return w.empty(); });
  Unfinished unfinished(request);
  write_bag(fs::path(request.cases) / "bags" / (request.name + ".bag"), input, !shipped);

  const std::string about =
      request.about.empty()
          ? "Recorded from " + fs::path(request.bag).filename().string() + " on " + stamp_of(file).date + "."
          : request.about;
  std::string text = fmt::format("about: {}\nbag: bags/{}.bag\nscene: {}\n", quoted(about), request.name,
                                 scene_of(input.garments));
  if (!input.sensors.empty())
    text += fmt::format(
        "pipeline:\n  # columns of one sensor: say how many a column has if they stand in columns\n"
        "  assembler: {{sensors: [{}], sensors_per_column: 1}}\n",
        fmt::join(input.sensors, ", "));
  if (!shipped) text += "garments: recorded  # in the bag\n";
  if (shipped && !words.empty()) text += fmt::format("garments: [{}]\n", fmt::join(words, ", "));
  text += "metrics:\n  refusal: {golden: null, reason: as recorded}\n";
  write(file, text);
  unfinished.done();
}

Outcome add_everything_found(const RecordRequest& request, const HarnessOptions& options) {
  const std::string file = fs::path(request.cases) / (request.name + ".yaml");
  Unfinished unfinished(request);
  Outcome outcome = run_case(load_case(file), options);
  const Verdict& verdict = outcome.verdicts.front();
  if (!verdict.faults.empty()) throw Refusal(kBadCase, file + ": " + verdict.faults.front());
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.resize(text.find("metrics:\n"));
  text +=
      "# Everything that was found. Keep what the case is about, delete the rest; a tolerance says how much "
      "may\n"
      "# change unnoticed, `reason` why. Names: tests/regression/metrics.hpp.\nmetrics:\n" +
      metric_lines(verdict.metrics);
  if (outcome.recording.body)
    text += "  # the skin by parts of the body: shapes/" + request.name +
            ".yaml\n"
            "  shape/centre: {expected: 0, tolerance: 0.0005, reason: half a millimetre can be felt}\n"
            "  shape/spread: {expected: 0, tolerance: 0.0005, reason: as the centre}\n"
            "  shape/area: {expected: 0, tolerance: 0.01, reason: 1 % of a part's skin}\n";
  write(file, text);
  outcome.asked = load_case(file);
  if (outcome.recording.body) write_shape(outcome.asked, outcome.recording);
  unfinished.done();
  return outcome;
}

}  // namespace tensegric_fit::regression
