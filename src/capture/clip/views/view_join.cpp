#include "capture/clip/views/view_join.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/statistics.hpp"
#include "base/verdict.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"
#include "wisp/model/shape_components.hpp"

namespace wisp {
namespace {

using Row = std::vector<double>;

// Offset of two series at which their normalised cross-correlation is highest, among offsets with enough overlap.
struct TimeOffset {
  double rows = 0;         ///< row of the first series at which the second begins
  double correlation = 0;  ///< correlation at that offset, −1 to 1
  double next_best = 0;    ///< highest correlation at offsets at least 1 s away from `rows`
  // Films of one flame correlate by at least 0.9, 0.3 above the next best; films of two flames by at most 0.3.
  bool certain() const { return correlation >= 0.6 && correlation - next_best >= 0.15; }
};

// Returns the correlation of first[k + lag] and second[k]; −1 if below `least` common rows, or a series is constant.
double correlation(std::span<const double> first, std::span<const double> second, std::ptrdiff_t lag, double least) {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  const auto end = std::min(std::ssize(second), std::ssize(first) - lag);
  for (auto k = std::max<std::ptrdiff_t>(0, -lag); k < end; ++k) {
    const double a = first[static_cast<std::size_t>(k + lag)], b = second[static_cast<std::size_t>(k)];
    if (std::isnan(a + b)) continue;
    count += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
  }
  const double power = count < least ? 0 : (xx - x * x / count) * (yy - y * y / count);
  return power > 1e-18 ? (xy - x * y / count) / std::sqrt(power) : -1;
}

// Returns the best offset of two series of equal rate; NaN marks missing values. None if no offset leaves the minimum
// overlap, or a series is constant wherever they overlap.
std::optional<TimeOffset> time_offset(std::span<const double> first, std::span<const double> second, double rate_hz) {
  // Minimum overlap: 2 s and 30 % of the shorter series. Shorter overlaps correlate by chance.
  const auto shorter = static_cast<double>(std::min(first.size(), second.size()));
  const double least = std::max(2 * rate_hz, 0.3 * shorter);
  std::vector<double> found;
  for (auto lag = -std::ssize(second); lag <= std::ssize(first); ++lag)
    found.push_back(correlation(first, second, lag, least));
  const auto best = std::max_element(found.begin(), found.end());
  if (*best <= -1) return std::nullopt;
  const auto at = best - found.begin();
  TimeOffset out{static_cast<double>(at - std::ssize(second)), *best, -1};
  for (std::ptrdiff_t k = 0; k < std::ssize(found); ++k) {
    if (std::abs(static_cast<double>(k - at)) >= rate_hz)
      out.next_best = std::max(out.next_best, found[static_cast<std::size_t>(k)]);
  }
  // Refines the maximum by a parabola through it and its neighbours, which exist, as both ends have −1.
  const double before = best[-1], after = best[1], bend = before - 2 * *best + after;
  if (bend < 0 && before > -1 && after > -1) out.rows += std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
  return out;
}

// A view's outlines in shape coordinates, y up, origin at the middle of the base at rest; empty without an outline.
struct ViewRows {
  double right_x = 1, right_z = 0;  // horizontal unit vector to the camera's right
  double begins = 0, scale = 1;     // first row, in rows of the first view; first view's pixels per own pixel
  std::vector<Row> rows;
  Row height;  // height of the tip's control points above the base; NaN where missing

  // Returns the shape at a row of the first view, interpolated and in the first view's pixels; empty if missing.
  Row at(double row) const {
    const double place = row - begins;
    const auto before = static_cast<std::size_t>(std::max(0.0, std::floor(place))), after = before + 1;
    if (place < 0 || before >= rows.size() || rows[before].empty()) return {};
    const double part = place - static_cast<double>(before);
    if (part > 1e-9 && (after >= rows.size() || rows[after].empty())) return {};
    Row out = rows[before];
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (part > 1e-9) out[k] += part * (rows[after][k] - out[k]);
      out[k] *= scale;
    }
    return out;
  }
};

struct Joint {
  std::optional<TimeOffset> sound, height;
  bool by_sound() const { return sound && (sound->certain() || !height || !height->certain()); }
  TimeOffset chosen() const { return by_sound() ? *sound : height.value_or(TimeOffset{}); }
};

double degrees_between(double a, double b) {
  const double turn = std::fmod(std::abs(a - b), 180.0);
  return std::min(turn, 180 - turn);
}

ViewRows view_rows(const FilmedView& view) {
  const Recording& recording = view.recording;
  const double angle = view.azimuth_degrees * std::numbers::pi / 180;
  ViewRows out{.right_x = std::cos(angle), .right_z = -std::sin(angle), .rows = {}, .height = {}};
  std::vector<const Row*> channels;
  for (std::string name = "p0"; find_channel(recording, name + ".x");
       name = "p" + std::to_string(channels.size() / 2)) {
    for (const char* axis : {".x", ".y"})
      channels.push_back(&recording.channels[*find_channel(recording, name + axis)].samples);
  }
  const std::size_t n = channels.size() / 2;
  Row base_x, base_y;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    Row control;
    for (const Row* channel : channels) control.push_back((*channel)[row] * (control.size() % 2 == 0 ? 1 : -1));
    const bool whole = std::none_of(control.begin(), control.end(), [](double value) { return std::isnan(value); });
    out.rows.push_back(whole ? shape_coordinates(control) : Row());
    out.height.push_back(whole ? out.rows.back()[n - 1] - out.rows.back()[1] : std::nan(""));
    if (whole) base_x.push_back(out.rows.back()[n]), base_y.push_back(out.rows.back()[1]);
  }
  const double x = median(std::move(base_x)), y = median(std::move(base_y));
  for (Row& row : out.rows) {
    for (std::size_t k = 0; k < row.size() / 2; k += 2) row[k + 1] -= y, row[n + k] -= x;
  }
  return out;
}

// Returns a view's time offsets to the first one: by sound, and by the flame's height, which is equal from every side.
Joint joint_of(const FilmedView& first, const FilmedView& other, const Row& height, const Row& other_height) {
  const auto logarithms = [](Row loudness) {
    for (double& rms : loudness) rms = std::log(rms + 1e-4);
    return loudness;
  };
  const double rate = first.recording.rate_hz;
  Joint out;
  if (!first.loudness.empty() && !other.loudness.empty()) {
    out.sound = time_offset(logarithms(first.loudness), logarithms(other.loudness), rate);
    if (out.sound) out.sound->rows += rate * (first.heard_from - other.heard_from);
  }
  out.height = time_offset(height, other_height, rate);
  return out;
}

// All views in the time and scale of the first view.
struct Joined {
  std::vector<ViewRows> views;
  std::vector<Joint> joints;              // one per view
  std::size_t first = 0, rows = 0;        // first common row, in rows of the first view; number of rows
  Row apart;                              // per complete row: standard deviation of the views' heights
  double height = 0, widest_degrees = 0;  // mean height in pixels; largest angle between views
  Recording recording;

  double heights_differ() const { return height > 0 ? 100 * mean(apart) / height : std::nan(""); }
};

Result<void> join_times(std::span<const FilmedView> views, Joined& joined) {
  const Recording& first = views[0].recording;
  double begin = 0, end = static_cast<double>(first.rows());
  for (const FilmedView& view : views) {
    const Recording& own = view.recording;
    const auto verdict = verdict_of(own);
    if (verdict && !verdict->usable) return Error{own.source + ": cannot be joined: " + verdict->reason};
    if (std::abs(own.rate_hz / first.rate_hz - 1) > 5e-4) {
      return Error{own.source + ": has " + number_text(own.rate_hz, 5) + " frames a second, but " + first.source +
                   " has " + number_text(first.rate_hz, 5) + "; film both at the same rate"};
    }
    ViewRows rows = view_rows(view);
    Joint joint;
    if (!joined.views.empty()) joint = joint_of(views[0], view, joined.views[0].height, rows.height);
    rows.begins = joint.chosen().rows;
    joined.views.push_back(std::move(rows));
    joined.joints.push_back(joint);
    for (const FilmedView& other : views)
      joined.widest_degrees =
          std::max(joined.widest_degrees, degrees_between(view.azimuth_degrees, other.azimuth_degrees));
    begin = std::max(begin, joined.views.back().begins);
    end = std::min(end, joined.views.back().begins + static_cast<double>(own.rows()));
    if (&view == &views[0] || ((joint.sound || joint.height) && end - begin >= 2 * first.rate_hz)) continue;
    return Error{own.source + ": has no time in common with " + first.source +
                 ": neither its sound nor the flame's height fits for 2 s; start both before you clap once"};
  }
  joined.first = static_cast<std::size_t>(std::ceil(begin));
  joined.rows = static_cast<std::size_t>(std::floor(end)) - joined.first;
  return {};
}

// Sets scales by the median ratio of heights, as a flame has equal height from every side.
void join_scales(Joined& joined) {
  const std::size_t top = 2 * (joined.recording.channels.size() / 6) - 1;
  for (ViewRows& view : joined.views) {
    Row ratios;
    for (std::size_t row = joined.first; row < joined.first + joined.rows; ++row) {
      const Row seen = view.at(static_cast<double>(row));
      const double height = seen.empty() ? 0 : seen[top] - seen[1];
      if (height > 1 && joined.views[0].height[row] > 1) ratios.push_back(joined.views[0].height[row] / height);
    }
    if (!ratios.empty()) view.scale = median(std::move(ratios));
  }
}

Recording empty_rings(const Recording& first, std::size_t count, const Joined& joined) {
  Recording out{.source = first.source, .rate_hz = first.rate_hz, .attributes = first.attributes};
  for (std::size_t k = 0; k < count; ++k) {
    for (const char* part : {".x", ".y", ".z", ".r", ".tx", ".tz"})
      out.channels.push_back({"ring" + std::to_string(k) + part, "px", Role::kMotion, Row(joined.rows, std::nan(""))});
  }
  out.flags = slice(first, joined.first, joined.first + joined.rows).flags;
  return out;
}

// Returns the horizontal vector whose projections on the cameras' right directions fit `coordinate` of the views best.
std::pair<double, double> level_vector(const Joined& joined, const std::vector<Row>& seen, std::size_t coordinate) {
  double xx = 0, xz = 0, zz = 0, x = 0, z = 0;
  for (std::size_t v = 0; v < seen.size(); ++v) {
    const ViewRows& view = joined.views[v];
    xx += view.right_x * view.right_x, xz += view.right_x * view.right_z, zz += view.right_z * view.right_z;
    x += view.right_x * seen[v][coordinate], z += view.right_z * seen[v][coordinate];
  }
  const double whole = xx * zz - xz * xz;
  return {(zz * x - xz * z) / whole, (xx * z - xz * x) / whole};
}

void join_rows(Joined& joined) {
  const std::size_t rings = joined.recording.channels.size() / 6, points = 2 * rings;
  Row all_heights;
  for (std::size_t row = 0; row < joined.rows; ++row) {
    std::vector<Row> seen;
    for (const ViewRows& view : joined.views) seen.push_back(view.at(static_cast<double>(joined.first + row)));
    if (std::any_of(seen.begin(), seen.end(), [](const Row& one) { return one.empty(); })) continue;
    const auto views_of = [&](std::size_t coordinate) {
      Row values;
      for (const Row& one : seen) values.push_back(one[coordinate]);
      return values;
    };
    for (std::size_t k = 0; k < rings; ++k) {
      const auto [x, z] = level_vector(joined, seen, points + 2 * k);
      const auto [tilt_x, tilt_z] = level_vector(joined, seen, points + 2 * k + 1);
      const double y = mean(views_of(2 * k + 1)), radius = mean(views_of(2 * k));
      std::size_t channel = 6 * k;
      for (const double value : {x, y, z, radius, tilt_x, tilt_z})
        joined.recording.channels[channel++].samples[row] = value;
    }
    joined.apart.push_back(deviation(views_of(points - 1)));
    all_heights.push_back(mean(views_of(points - 1)));
  }
  joined.height = mean(all_heights);
}

ReportVerdict verdict_on(const Joined& joined) {
  double worst = 1;
  for (std::size_t v = 1; v < joined.joints.size(); ++v) worst = joined.joints[v].chosen().certain() ? worst : 0;
  const auto whole = static_cast<double>(joined.apart.size()), rows = static_cast<double>(joined.rows);
  const Criterion criteria[] = {
      {joined.widest_degrees, Bound::kAtLeast, 20,
       "its films are {figure}° from each other, expected at least {limit}°; put the cameras a quarter turn apart", 0},
      {worst, Bound::kAtLeast, 1,
       "when its films began is not certain, by sound or by the flame's height; clap once while all of them run", 0},
      {joined.heights_differ(), Bound::kAtMost, 8,
       "its films differ in the flame's height by {figure} % of it, at most {limit} % can be; are the cameras level, "
       "and is it the same flame?"},
      {100 * whole / rows, Bound::kAtLeast, 50,
       "all films have an outline in {figure} % of the frames, expected at least {limit} %", 0}};
  const auto missed = first_missed(criteria);
  return {!missed, missed ? *missed : "the films agree on when it was and how high the flame is"};
}

ReportSection views_section(std::span<const FilmedView> views, const Joined& joined) {
  ReportTable table{
      "views",
      "Films",
      {{"film", "film"}, {"azimuth", "azimuth", "°"}, {"scale", "scale"}, {"begins", "begins", "s"}, {"by", "by"}},
      {}};
  for (const char* by : {"sound", "height"}) {
    const std::string id = by, words = "by its " + id;
    table.columns.insert(table.columns.end(),
                         {{id, words, "s"}, {id + "_correlation", "correlation"}, {id + "_next", "next best"}});
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Joint& joint = joined.joints[v];
    const double rate = views[0].recording.rate_hz;
    table.rows.push_back({views[v].recording.source, views[v].azimuth_degrees, joined.views[v].scale,
                          joint.chosen().rows / rate,
                          joint.by_sound() ? "sound"
                          : joint.height   ? "height"
                                           : ""});
    for (const auto* offset : {&joint.sound, &joint.height}) {
      const bool known = offset->has_value();
      for (const double figure :
           {known ? (*offset)->rows / rate : 0, known ? (*offset)->correlation : 0, known ? (*offset)->next_best : 0})
        table.rows.back().push_back(known ? ReportValue(figure) : ReportValue());
    }
  }
  return {"Views",
          {{"rows", joined.rows, "frames in common", ""},
           {"apart_degrees", joined.widest_degrees, "widest angle", "°"},
           {"heights_differ", joined.heights_differ(), "heights differ by", "%", {}, "of the height"}},
          {std::move(table)}};
}

}  // namespace

Result<void> check_azimuths(std::span<const double> azimuths, std::span<const std::string> names) {
  if (names.size() < 2) return Error{"one film shows a flame from one side; expected at least two films"};
  if (azimuths.size() != names.size()) {
    return Error{std::to_string(azimuths.size()) + " angles for " + std::to_string(names.size()) +
                 " films; expected one each"};
  }
  for (std::size_t b = 0; b < azimuths.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (degrees_between(azimuths[a], azimuths[b]) >= 1) continue;
      return Error{names[b] + ": is from the same direction as " + names[a] + ", or the opposite one, at " +
                   number_text(azimuths[b], 5) + "°; its outline tells nothing new"};
    }
  }
  return {};
}

Result<Captured> join_views(std::span<const FilmedView> views) {
  std::vector<double> azimuths;
  std::vector<std::string> names;
  std::size_t points = 0;
  for (const FilmedView& view : views) {
    azimuths.push_back(view.azimuth_degrees);
    names.push_back(view.recording.source);
    const auto curve = curve_of(view.recording);
    const std::size_t own = curve ? curve->knots.size() - 4 : 0;
    if (points == 0) points = own;
    if (own == 0 || own != points || own % 2 != 0)
      return Error{names.back() + ": has " + std::to_string(own) +
                   " control points, expected an even number, the same in all films"};
  }
  if (auto ok = check_azimuths(azimuths, names); !ok) return ok.error();
  Joined joined;
  if (auto ok = join_times(views, joined); !ok) return ok.error();
  joined.recording = empty_rings(views[0].recording, points / 2, joined);
  join_scales(joined);
  join_rows(joined);
  Captured out;
  out.report.sections.push_back(views_section(views, joined));
  const auto heard = std::find_if(views.begin(), views.end(), [](const FilmedView& view) {
    return !channels_with_role(view.recording, Role::kInput).empty();
  });
  const bool any = heard != views.end();
  const double row = static_cast<double>(joined.first) - (any ? joined.views[heard - views.begin()].begins : 0);
  out.report.sections.push_back(see_from_beside(any ? &heard->recording : nullptr, row, joined.recording));
  set_numbers_attribute(joined.recording, "azimuths", azimuths);
  out.report.verdict = verdict_on(joined);
  out.recording = std::move(joined.recording);
  set_verdict(out.recording, out.report.verdict->usable, out.report.verdict->reason);
  return out;
}

}  // namespace wisp
