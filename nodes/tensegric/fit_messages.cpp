#include "tensegric/fit_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/even_steps.hpp"
#include "geometry/status.hpp"
#include "ros/flat.hpp"
#include "tensegric/members.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::node {
namespace {

using tensegric::TensionLaw;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const GarmentLine& line, const std::string& what) {
  throw geometry::Refusal(geometry::refusal::kBadGarment, fmt::format("line '{}': {}", line.name, what));
}

TensionLaw law_in(const GarmentLine& line) {
  TensionLaw law;
  if (line.law.empty() && (line.stiffness != 0 || !line.stretch.empty() || !line.tension.empty()))
    refuse(line, "has a stiffness or a table, and no 'law' that says so");
  if (line.law.empty() || line.law == GarmentLine::RIGID) return law;
  if (line.law == GarmentLine::STIFFNESS) {
    if (line.stiffness == 0) refuse(line, "law 'stiffness' needs a stiffness");
    law.kind = TensionLaw::Kind::stiffness;
    law.stiffness = line.stiffness;
    return law;
  }
  if (line.law != GarmentLine::TABLE)
    refuse(line, fmt::format("law '{}' is not one of: rigid, stiffness, table", line.law));
  if (line.stretch.size() != line.tension.size()) refuse(line, "a table needs a tension for each stretch");
  law.kind = TensionLaw::Kind::table;
  for (std::size_t i = 0; i < line.stretch.size(); ++i)
    law.table.emplace_back(line.stretch[i], line.tension[i]);
  return law;
}

tensegric::GarmentLine line_in(const GarmentLine& message) {
  const std::string where = fmt::format("line '{}'", message.name);
  tensegric::GarmentLine line;
  line.name = message.name;
  line.ratio = message.ratio;
  line.law = law_in(message);
  line.tension_limit = message.tension_limit == 0 ? kNoLimit : message.tension_limit;
  line.taut = message.taut;
  if (message.points.size() % 3 != 0) refuse(message, "points needs x y z of each point");
  line.points = points_in(message.points);
  if (line.points.empty()) {
    const auto fan = std::find(message.through.begin(), message.through.end(), tensegric::kFan);
    line.through.assign(message.through.begin(), fan);
    if (fan != message.through.end()) line.fan.assign(fan + 1, message.through.end());
    if (fan != message.through.end() && line.fan.empty()) refuse(message, "no nodes come after 'fan'");
  } else if (!message.through.empty()) {
    line.held = tensegric::held_in(message.through, where + " by points");
  }
  line.width = message.width;
  line.smooth = message.smooth;
  tensegric::check_line(line, where);
  return line;
}

std::string word_of(TensionLaw::Kind kind) {
  return kind == TensionLaw::Kind::rigid       ? GarmentLine::RIGID
         : kind == TensionLaw::Kind::stiffness ? GarmentLine::STIFFNESS
                                               : GarmentLine::TABLE;
}

double limit_of(double tension_limit) {
  return tension_limit == kNoLimit ? 0 : tension_limit;
}

GarmentLine line_of(const tensegric::GarmentLine& line) {
  GarmentLine message;
  message.name = line.name;
  message.ratio = line.ratio;
  message.law = word_of(line.law.kind);
  message.stiffness = line.law.stiffness;
  for (const auto& [stretch, tension] : line.law.table) {
    message.stretch.push_back(stretch);
    message.tension.push_back(tension);
  }
  message.tension_limit = limit_of(line.tension_limit);
  message.through = line.through;
  if (!line.fan.empty()) {
    message.through.push_back(tensegric::kFan);
    message.through.insert(message.through.end(), line.fan.begin(), line.fan.end());
  }
  if (!line.points.empty())
    for (const bool held : line.held)
      message.through.emplace_back(held ? tensegric::kHeldByBone : tensegric::kCarriedBySkin);
  message.taut = line.taut;
  message.points = flat<double>(line.points);
  message.width = line.width;
  message.smooth = line.smooth;
  return message;
}

FitState named(const FitName& name) {
  FitState message;
  message.header = name.tag.header;
  message.scan_id = name.tag.scan_id;
  message.garment = name.garment;
  message.solver = to_string(name.solver);
  message.twist = name.posture.twist;
  message.side_lean = name.posture.side_lean;
  return message;
}

}  // namespace

Garment to_message(const std_msgs::Header& header, const GarmentRequest& request) {
  Garment message;
  message.header = header;
  message.name = request.garment.name;
  message.regions = request.garment.regions;
  for (const tensegric::GarmentLine& line : request.garment.lines) message.lines.push_back(line_of(line));
  message.solver = request.solver;
  return message;
}

GarmentRequest request_in(const Garment& message) {
  GarmentRequest request;
  request.garment.name = message.name;
  request.garment.regions = message.regions;
  if (message.lines.empty())
    throw geometry::Refusal(geometry::refusal::kBadGarment, "the garment has no lines");
  std::set<std::string> names;
  for (const GarmentLine& line : message.lines) {
    if (!names.insert(line.name).second) refuse(line, "another line has the same name");
    request.garment.lines.push_back(line_in(line));
  }
  if (!message.solver.empty()) tensegric::solver_from(message.solver);
  request.solver = message.solver;
  return request;
}

GarmentRequest request_in(const SetGarment::Request& request, const std::string& folder) {
  if (request.name.empty() && request.garment.lines.empty())
    throw geometry::Refusal(geometry::refusal::kBadGarment,
                            "the request has neither a garment's name nor a garment with lines");
  GarmentRequest asked = request.name.empty()
                             ? request_in(request.garment)
                             : GarmentRequest{tensegric::take_garment(request.name, folder), ""};
  if (request.lines.size() != request.ratios.size())
    throw geometry::Refusal(geometry::refusal::kBadGarment,
                            "`lines` and `ratios` must have one entry for each other");
  std::set<std::string> lines;
  for (std::size_t i = 0; i < request.lines.size(); ++i) {
    if (!lines.insert(request.lines[i]).second)
      throw geometry::Refusal(geometry::refusal::kBadGarment,
                              "`lines` has '" + request.lines[i] + "' more than once");
    tensegric::set_ratio(asked.garment, request.lines[i], request.ratios[i]);
  }
  return asked;
}

FitState to_message(const FitName& name, const tensegric::Solution& solution, double milliseconds) {
  FitState message = named(name);
  message.status = to_string(solution.status);
  message.iteration = static_cast<std::uint32_t>(solution.iterations);
  message.residual = solution.residual;
  message.milliseconds = milliseconds;
  message.note = solution.note;
  message.outer = flat<double>(solution.outer);
  message.inner = flat<double>(solution.inner);
  for (const tensegric::LineResult& line : solution.lines) {
    LineResult result;
    result.name = line.name;
    result.nodes.assign(line.nodes.begin(), line.nodes.end());
    result.course_at_rest = flat<double>(line.course_at_rest);
    result.course = flat<double>(line.course);
    result.initial = line.initial;
    result.neutral = line.neutral;
    result.final = line.final;
    result.request = line.request;
    result.ratio = line.final / line.initial;
    result.straight = line.straight;
    result.reachable = line.reachable;
    result.tension = line.tension;
    result.law = word_of(line.law.kind);
    result.stiffness = line.law.stiffness;
    for (const auto& [stretch, tension] : line.law.table) {
      result.table_stretch.push_back(stretch);
      result.table_tension.push_back(tension);
    }
    result.tension_limit = limit_of(line.tension_limit);
    message.line_ratios.push_back(result.ratio);
    message.lines.push_back(std::move(result));
  }
  for (const tensegric::RegionResult& region : solution.regions) {
    RegionResult result;
    result.name = region.name;
    result.volume_before = region.volume_before;
    result.volume_after = region.volume_after;
    message.volume_errors.push_back(region.kept_error);
    message.regions.push_back(std::move(result));
  }
  return message;
}

FitState to_message(const FitName& name, const tensegric::Iterate& iterate,
                    const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner,
                    double milliseconds) {
  FitState message = named(name);
  message.status = FitState::SOLVING;
  message.iteration = static_cast<std::uint32_t>(iterate.iteration);
  message.residual = iterate.residual;
  message.milliseconds = milliseconds;
  message.outer = flat<double>(outer);
  message.inner = flat<double>(inner);
  message.line_ratios = iterate.line_ratios;
  message.volume_errors = iterate.volume_errors;
  return message;
}

LineForces forces_message(const FitName& name, const tensegric::Solution& solution) {
  LineForces message;
  message.header = name.tag.header;
  message.scan_id = name.tag.scan_id;
  message.garment = name.garment;
  if (!solution.calibrated) return message;
  for (const tensegric::LineResult& line : solution.lines) {
    message.lines.push_back(line.name);
    message.tension.push_back(line.tension);
    message.newtons.push_back(line.newtons);
    message.kilopascals.push_back(1e-3 * line.pressure);
  }
  return message;
}

BandShapes bands_message(const FitName& name, const tensegric::Solution& solution) {
  BandShapes message;
  message.header = name.tag.header;
  message.scan_id = name.tag.scan_id;
  message.garment = name.garment;
  for (const tensegric::LineResult& line : solution.lines) {
    if (line.fibres.size() < 2) continue;
    std::size_t count = 0;
    for (const auto& fibre : line.fibres) count = std::max(count, fibre.size());
    BandShape band;
    band.line = line.name;
    band.tension = line.tension;
    band.width = line.width;
    band.fibres = static_cast<std::uint32_t>(line.fibres.size());
    for (std::size_t f = 0; f < line.fibres.size(); ++f) {
      const auto places = geometry::even_places(line.fibres_at_rest[f], static_cast<int>(count));
      for (const auto& [fibres, values] :
           {std::pair(&line.fibres_at_rest, &band.at_rest), {&line.fibres, &band.worn}})
        for (const auto& [segment, share] : places) {
          const Eigen::Vector3d &a = (*fibres)[f][segment], &b = (*fibres)[f][segment + 1];
          for (const double value : Eigen::Vector3d(a + share * (b - a)))
            values->push_back(static_cast<float>(value));
        }
    }
    message.bands.push_back(std::move(band));
  }
  return message;
}

MemberForces to_message(const ScanTag& tag, const std::string& garment, const tensegric::Model& model,
                        const tensegric::Solution& solution) {
  const tensegric::Positions nodes = tensegric::positions_of(solution);
  const double mean = model.mean_tension();
  MemberForces message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.garment = garment;
  message.nodes = flat<double>(nodes);
  for (const tensegric::Member& member : model.members) {
    message.ends.push_back(static_cast<std::uint32_t>(member.a));
    message.ends.push_back(static_cast<std::uint32_t>(member.b));
    message.struts.push_back(member.strut);
    const double length = (nodes[member.b] - nodes[member.a]).norm();
    message.forces.push_back(tensegric::tension(member, length) / mean);
  }
  return message;
}

}  // namespace tensegric_fit::node
