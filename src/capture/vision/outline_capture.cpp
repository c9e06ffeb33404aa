#include "wisp/capture/vision/outline_capture.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "capture/vision/candle_look.hpp"
#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/film_look.hpp"
#include "capture/vision/outline_rows.hpp"
#include "capture/vision/outline_seeker.hpp"
#include "capture/vision/outline_tracker.hpp"
#include "capture/vision/survey.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

constexpr std::size_t kMinTracked = 10;
constexpr int kEdgePoints = 192;       // more add no stability, as errors correlate
constexpr std::size_t kSurveyed = 20;  // maximum number of held frames in the survey
constexpr std::size_t kSamples = 6;    // maximum number of held frames from which the curve's shape is chosen

// An object burns from these on. Change of shape: flames reach 0.05 and more in a second, lit walls and lamps 0.015 at
// most, but a round lamp 24 pixels wide, filmed by hand, reaches 0.05: what is wider than kMaxWidth must surely move.
constexpr double kMinChange = 0.02;
constexpr double kMinNarrowing = 0.25;
constexpr double kMaxWidth = 0.8;  // of the height

// The underside is followed if the misfit of every sample falls below this share, as it takes control points from the
// sides and makes them move more. Every sample counts: a flame that is calm at first may lift a foot later.
constexpr double kWorthFollowing = 0.6;

bool worth_following(const CurveShape& around, const CurveShape& above) {
  return std::equal(around.misfits.begin(), around.misfits.end(), above.misfits.begin(), above.misfits.end(),
                    [](double with, double without) { return with < kWorthFollowing * without; });
}

// Returns whether the object burns; if not, the capture waits for a flame to be lit. The verdict would refuse objects
// that stand still or exceed their surroundings too little.
bool burns(const Survey& survey) {
  const Region place = usual_place(survey.seen);
  return survey.change >= (place.width > kMaxWidth * place.height ? kSurelyMoves : kMinChange) &&
         survey.taper >= kMinNarrowing && survey.contrast >= kNoise;
}

// Returns at most `count` of the pictures, equally spaced.
std::vector<Picture> evenly_from(std::span<const Picture> pictures, std::size_t count) {
  std::vector<Picture> out;
  const std::size_t stride = (pictures.size() + count - 1) / count;
  for (std::size_t k = stride / 2; k < pictures.size(); k += stride) out.push_back(pictures[k]);
  return out;
}

}  // namespace

// State of a capture between frames.
class OutlineCapture::Stage {
 public:
  explicit Stage(OutlineCaptureOptions options) : options_(std::move(options)) {}

  Result<void> feed(const Picture& picture);
  void glimpse(const Picture& picture) { glimpses_.emplace_back(picture); }
  void lost();
  OutlineSeen seen() const;
  FilmFacts film() const { return film_.facts(); }
  Result<CapturedOutline> finish();

 private:
  double bright(int stored) const;
  Result<void> accept(const Picture& picture);
  Result<void> decide(bool at_end = false);
  void wait_on(const Result<Survey>& survey);
  std::string too_few(const Survey& survey) const;
  struct Samples {
    std::vector<EdgeCloud> above;   // paths from corner to corner over the tip
    std::vector<EdgeCloud> around;  // paths including the underside
  };
  Samples take_samples(std::span<const Picture> pictures) const;
  std::vector<double> decide_shape(Samples& samples);
  void look(const Picture& picture);
  void note(const FrameFinding& finding);
  Error complaint(const std::string& what) const { return Error{options_.source + ": " + what}; }
  Error no_flame(const std::string& why) const;
  void describe(CapturedOutline& out) const;

  OutlineCaptureOptions options_;
  std::size_t fed_ = 0;
  std::vector<std::optional<OwnedPicture>> held_;  // empty: a lost frame
  std::size_t held_bytes_ = 0;
  bool burns_ = true;    // the survey's object looks lit and moves
  bool waited_ = false;  // whether the capture waited for a flame absent at first
  struct Waited {
    Region place;
    std::size_t rows = 0;
  };
  std::vector<Waited> stood_still_;  // motionless objects seen while the capture waited
  std::vector<OwnedPicture> glimpses_;
  std::optional<Survey> survey_;
  std::optional<CandleLook> candle_;
  std::optional<Picture> format_;  // size and layout of the first picture, without its planes
  std::optional<OutlineSeeker> seeker_;
  std::optional<OutlineTracker> tracker_;
  FilmLook film_;
  EdgeCloudOptions cloud_options_;
  EdgeCloud cloud_;
  FrameFindings findings_;
};

Result<void> OutlineCapture::Stage::accept(const Picture& picture) {
  if (fed_++ == 0) {
    format_ = picture;
    const Region& region = options_.region;
    if (!region.empty() && !(intersection(region, picture.frame()) == region)) {
      return complaint("the region " + std::to_string(region.x) + "," + std::to_string(region.y) + "," +
                       std::to_string(region.width) + "," + std::to_string(region.height) +
                       " reaches outside the picture of " + std::to_string(picture.width) + " x " +
                       std::to_string(picture.height) + " pixels; give one inside it as X,Y,W,H");
    }
    if (options_.channel && !has_channel(picture, *options_.channel)) {
      return complaint("found grey pictures, expected colour for channel " +
                       std::string(channel_name(*options_.channel)) + "; use luma");
    }
    return {};
  }
  if (picture.width != format_->width || picture.height != format_->height) {
    return complaint("frame " + std::to_string(fed_ - 1) + " is " + std::to_string(picture.width) + " x " +
                     std::to_string(picture.height) + " pixels, expected " + std::to_string(format_->width) + " x " +
                     std::to_string(format_->height) + " as the first one");
  }
  return {};
}

Result<void> OutlineCapture::Stage::feed(const Picture& picture) {
  if (auto accepted = accept(picture); !accepted) return accepted;
  film_.look(picture);
  if (survey_) {
    look(picture);
    return {};
  }
  held_.emplace_back(OwnedPicture(picture));
  held_bytes_ += held_.back()->bytes();
  const bool enough = held_.size() >= static_cast<std::size_t>(options_.held_frames) ||
                      (held_bytes_ >= options_.held_bytes && held_.size() >= kMinTracked);
  return enough ? decide() : Result<void>();
}

void OutlineCapture::Stage::lost() {
  film_.lost();
  if (survey_) return note({FrameFinding::Kind::kLost});
  held_.emplace_back(std::nullopt);
}

// Records a frame; its control points are 0 unless they have been appended.
void OutlineCapture::Stage::note(const FrameFinding& finding) {
  findings_.frames.push_back(finding);
  findings_.controls.resize(2 * static_cast<std::size_t>(options_.points) * findings_.size());
}

// Notes the first half of the held frames as empty, as they contain no flame yet. Later surveys leave out the glimpses,
// as no flame was found in them either; the curve's shape is still sampled from them.
void OutlineCapture::Stage::wait_on(const Result<Survey>& survey) {
  const std::size_t half = (held_.size() + 1) / 2;
  if (survey && survey->change < kMinChange) stood_still_.push_back({survey->home, half});
  for (std::size_t k = 0; k < half; ++k) {
    note({held_[k] ? FrameFinding::Kind::kNothing : FrameFinding::Kind::kLost});
    if (held_[k]) held_bytes_ -= held_[k]->bytes();
  }
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(half));
  waited_ = true;
}

Result<void> OutlineCapture::Stage::decide(bool at_end) {
  std::vector<Picture> pictures;
  for (const auto& held : held_) {
    if (held) pictures.push_back(held->picture());
  }
  cloud_options_.max_points = kEdgePoints;
  std::vector<Picture> seen = evenly_from(pictures, kSurveyed);
  for (const OwnedPicture& glimpse : glimpses_) {
    if (!waited_) seen.push_back(glimpse.picture());
  }
  auto survey = survey_scene(seen, {options_.channel, options_.dark, options_.region, options_.flame});
  const bool flame = options_.flame > 0 && !options_.dark;
  // A flame lit halfway through the held frames appears in too few of them, so more frames are awaited.
  const bool throughout = survey && (!waited_ || 3 * survey->seen.size() >= 2 * seen.size());
  burns_ = !flame || (throughout && burns(*survey));
  if (!burns_ && !at_end) {
    wait_on(survey);
    return {};
  }
  if (!survey) return no_flame(survey.error().message);
  if (flame && survey->flames < options_.flame) return complaint(too_few(*survey));
  survey_ = std::move(*survey);
  if (survey_->flames > 0) candle_ = look_of_candle(pictures, survey_->home);
  const Region area = options_.region.empty() ? pictures.front().frame() : options_.region;
  cloud_options_.base = survey_->flames > 0 ? BaseSide::kBottom : base_side(*survey_, area);
  seeker_.emplace(*survey_, area, cloud_options_.base, options_.dark);
  Samples samples = take_samples(pictures);
  tracker_.emplace(decide_shape(samples));
  for (const auto& held : held_) {
    if (held) {
      look(held->picture());
    } else {
      note({FrameFinding::Kind::kLost});
    }
  }
  held_.clear();
  held_.shrink_to_fit();
  glimpses_.clear();
  return {};
}

// Returns the error that no flame was found, with the film's property that explains it.
Error OutlineCapture::Stage::no_flame(const std::string& why) const {
  if (options_.flame == 0 || options_.dark) return complaint(why);
  return complaint(film_reason(film_.facts()).value_or("there is no flame in the film: " + why));
}

// Explains that fewer than `options_.flame` flames were found, and where they were counted.
std::string OutlineCapture::Stage::too_few(const Survey& survey) const {
  return "found " + std::to_string(survey.flames) + (survey.flames == 1 ? " flame" : " flames") + " in frames " +
         std::to_string(findings_.size() + options_.first_frame) + " to " +
         std::to_string(findings_.size() + held_.size() + options_.first_frame - 1) + ", expected at least " +
         std::to_string(options_.flame) + "; ask for a smaller number, or give the frames in which there are more";
}

// Returns the edge points of a few pictures and glimpses, without and with the underside.
OutlineCapture::Stage::Samples OutlineCapture::Stage::take_samples(std::span<const Picture> pictures) const {
  EdgeCloudOptions above = cloud_options_, around = cloud_options_;
  around.underside = true;
  Samples samples;
  EdgeCloud cloud;
  const auto take = [&](OutlineSeeker& looking, const Picture& picture) {
    if (!looking.seek(picture)) return;
    if (looking.edge_points(above, cloud)) samples.above.push_back(cloud);
    if (looking.edge_points(around, cloud)) samples.around.push_back(cloud);
  };
  OutlineSeeker following = *seeker_;
  for (const Picture& picture : evenly_from(pictures, kSamples)) take(following, picture);
  for (const OwnedPicture& glimpse : glimpses_) {
    OutlineSeeker anew = *seeker_;
    take(anew, glimpse.picture());
  }
  return samples;
}

// Decides whether the underside is followed, the positions of the landmarks, and the knots. Returns the knots.
std::vector<double> OutlineCapture::Stage::decide_shape(Samples& samples) {
  CurveShape best;
  for (const bool underside : {false, true}) {
    if (options_.underside.value_or(underside) != underside) continue;
    std::vector<EdgeCloud>& clouds = underside ? samples.around : samples.above;
    if (clouds.empty()) continue;
    EdgeCloudOptions options = cloud_options_;
    options.underside = underside;
    options.landmarks = {0, 0, 0};
    for (const EdgeCloud& cloud : clouds) {
      for (int k = 0; k < 3; ++k) options.landmarks[k] += cloud.shares[k] / static_cast<double>(clouds.size());
    }
    for (EdgeCloud& cloud : clouds) place_points(cloud, options);
    CurveShape shape =
        options_.knots.empty() ? choose_shape(clouds, options_.points) : fit_pace(clouds, options_.knots);
    if (!best.knots.empty() && !worth_following(shape, best)) continue;
    best = std::move(shape);
    options.pace = best.pace;
    cloud_options_ = options;
  }
  return best.knots.empty() ? uniform_knots(options_.points) : best.knots;
}

void OutlineCapture::Stage::look(const Picture& picture) {
  FrameFinding finding;
  const bool seen = seeker_->seek(picture) && seeker_->edge_points(cloud_options_, cloud_);
  if (seen) {
    const OutlineEstimate& estimate = tracker_->update(cloud_);
    film_.remember(picture);
    finding.kind = FrameFinding::Kind::kTracked;
    finding.change = static_cast<float>(seeker_->change());
    finding.brightness = static_cast<float>(seeker_->brightness());
    finding.residual = static_cast<float>(estimate.residual);
    findings_.controls.insert(findings_.controls.end(), estimate.mean.begin(), estimate.mean.end());
  } else {
    // Once the scene is known, an object elsewhere counts only where no light was before, since it may be a lamp.
    finding.elsewhere = film_.empty() ? seeker_->elsewhere()
                                      : film_.another(picture, picture.frame()) ||
                                            (seeker_->elsewhere() && film_.another(picture, seeker_->found().box));
    tracker_->forget();
  }
  note(finding);
}

// Converts a level of the survey's channel (inverted if the object is dark) to brightness.
double OutlineCapture::Stage::bright(int stored) const {
  return brightness(*format_, survey_->channel, options_.dark ? 255 - stored : stored);
}

OutlineSeen OutlineCapture::Stage::seen() const {
  OutlineSeen out;
  out.frames = findings_.size() + held_.size();
  out.decided = tracker_.has_value();
  if (!out.decided) return out;
  out.channel = survey_->channel;
  out.threshold = bright(survey_->level);
  out.clipped = survey_->clipped;
  out.flames = survey_->flames;
  out.found = seeker_->found().box;
  if (findings_.frames.back().kind != FrameFinding::Kind::kTracked) return out;
  const auto controls = std::span(findings_.controls).last(2 * static_cast<std::size_t>(options_.points));
  for (const CurvePoint p : curve_polyline(tracker_->table(), controls, kCurvePoints)) {
    out.polyline.insert(out.polyline.end(), {p.x, p.y});
  }
  return out;
}

void OutlineCapture::Stage::describe(CapturedOutline& out) const {
  CaptureReport& report = out.report;
  report.flames = survey_->flames;
  report.facts.film = film_.facts();
  report.facts.burns = burns_;
  report.facts.light = survey_->light;
  report.facts.clipped = survey_->clipped;
  report.facts.contrast = survey_->contrast;
  report.facts.steadiness = survey_->steadiness;
  for (const Waited& waited : stood_still_) {
    if (shared_share(waited.place, survey_->home) > kSamePlace) report.facts.still += waited.rows;
  }
  report.rate_hz = options_.rate_hz;
  report.first_frame = options_.first_frame;
  report.points = options_.points;
  report.channel = survey_->channel;
  report.width = format_->width;
  report.height = format_->height;
  report.threshold = bright(survey_->level);
  for (int v = 0; v < 256; ++v) {
    report.histogram[static_cast<std::size_t>(std::lround(bright(v)))] += survey_->histogram[v];
  }
  const auto knots = tracker_->table().knots();
  report.knots.assign(knots.begin(), knots.end());
  report.knots_placed = report.knots != uniform_knots(options_.points);
  report.underside = cloud_options_.underside;
  Recording& recording = out.recording;
  recording.source = options_.source;
  recording.rate_hz = options_.rate_hz;
  if (report.knots_placed) set_numbers_attribute(recording, "knots", knots);
  if (candle_)
    set_numbers_attribute(recording, "candle",
                          std::array{candle_->width, candle_->rgb[0], candle_->rgb[1], candle_->rgb[2]});
  recording.attributes.push_back({"source", options_.source});
  recording.attributes.push_back({"width", std::to_string(format_->width)});
  recording.attributes.push_back({"height", std::to_string(format_->height)});
  recording.attributes.push_back({"channel", std::string(channel_name(survey_->channel))});
  recording.attributes.push_back({"threshold", number_text(report.threshold, 6)});
  recording.attributes.push_back({"underside", report.underside ? "1" : "0"});
}

Result<CapturedOutline> OutlineCapture::Stage::finish() {
  if (fed_ < kMinTracked) {
    return complaint("found " + std::to_string(fed_) + " frames, expected at least " + std::to_string(kMinTracked) +
                     "; give a longer clip");
  }
  if (!survey_) {
    if (auto decided = decide(true); !decided) return decided.error();
  }
  CapturedOutline out;
  describe(out);
  assemble_rows(findings_, options_.points, out.recording, out.report);
  if (out.report.tracked < kMinTracked) {
    return no_flame("an outline was found in " + std::to_string(out.report.tracked) + " of " +
                    std::to_string(out.report.frames) + " frames, expected at least " + std::to_string(kMinTracked) +
                    "; try another channel, or a region around the thing");
  }
  if (gather_facts(out.recording, tracker_->table(), out.report)) judge_outline(out.report);
  return out;
}

OutlineCapture::OutlineCapture(OutlineCaptureOptions options) : stage_(std::make_unique<Stage>(std::move(options))) {}
OutlineCapture::OutlineCapture(OutlineCapture&&) noexcept = default;
OutlineCapture& OutlineCapture::operator=(OutlineCapture&&) noexcept = default;
OutlineCapture::~OutlineCapture() = default;

Result<void> OutlineCapture::feed(const Picture& picture) { return stage_->feed(picture); }

void OutlineCapture::glimpse(const Picture& picture) { stage_->glimpse(picture); }

void OutlineCapture::lost(int count) {
  for (int k = 0; k < count; ++k) stage_->lost();
}

FilmFacts OutlineCapture::film() const { return stage_->film(); }

OutlineSeen OutlineCapture::seen() const { return stage_->seen(); }

Result<CapturedOutline> OutlineCapture::finish() { return stage_->finish(); }

}  // namespace wisp
