// `wisp export`: converts a model to a file for another tool.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "commands/commands.hpp"
#include "films/looped.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/base/result.hpp"
#include "wisp/draw/film_strip.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/file.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {
namespace {

// Fades the halo out over `room` pixels before the frame's edges, so that the frame does not show as a box.
void fade_edges(float room, Image& image) {
  const auto share = [&](int at, int size) {
    const float t = std::min(1.0F, static_cast<float>(std::min(at, size - 1 - at)) / room);
    return t * t * (3 - 2 * t);
  };
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      std::uint32_t& pixel = image.row(y)[static_cast<std::size_t>(x)];
      const float kept = share(x, image.width()) * share(y, image.height());
      std::uint32_t faded = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        faded |= static_cast<std::uint32_t>(std::lround(kept * static_cast<float>(pixel >> shift & 0xff))) << shift;
      }
      pixel = faded;
    }
  }
}

struct Pages {
  std::vector<std::size_t> frames;  // indices of frames in the take
  int height = 0, width = 0;        // size of a frame; width 0: the maximum width of flame and halo
};

// Frames of a take that are drawn one at a time, as a long film's would not fit into memory.
struct FlamePages {
  Flipbook book;  // without frames
  std::function<Image(std::size_t)> draw;
};

// Errors: the model is no flame; the height is not 16 to 2048.
Result<FlamePages> flame_pages(const Model& model, const Take& take, const Pages& pages) {
  const int height = pages.height;
  constexpr int kPoints = 96;
  constexpr float kHalo = 0.35F;  // margin around the flame, in flame heights
  if (!is_flame(model))
    return Error{
        "the model is no flame to draw as light; an outline goes into a .json, a body's motion into a .glb, a lamp "
        "into a .c"};
  if (height < 16 || height > 2048)
    return Error{"a frame is " + std::to_string(height) + " pixels high, expected 16 to 2048"};
  float left = 0, right = 0, top = 0;
  std::vector<std::vector<Point>> outlines;
  for (const std::size_t frame : pages.frames) {
    const auto points = outline_of(model, take, frame, 0, kPoints);
    outlines.emplace_back();
    for (std::size_t k = 0; k < points.size(); k += 2) {
      outlines.back().push_back({points[k], points[k + 1]});
      left = std::min(left, points[k]);
      right = std::max(right, points[k]);
      top = std::max(top, points[k + 1]);
    }
  }
  // At the minimum of glow_reach, the halo nearly fits into the margin; fade_edges() removes the rest.
  const FlameStyle style{.glow_reach = 0.25F, .candle = false};
  FlameScene scene;
  const float across = right - left + 2 * kHalo;
  scene.pixels_per_unit = static_cast<float>(height) / (top + 2 * kHalo);
  if (pages.width > 0)
    scene.pixels_per_unit = std::min(scene.pixels_per_unit, static_cast<float>(pages.width) / across);
  const float room = kHalo * scene.pixels_per_unit, reach = across * scene.pixels_per_unit;
  const int width = pages.width > 0 ? pages.width : static_cast<int>(std::ceil(reach));
  const float margin = pages.width > 0 ? (static_cast<float>(width) - reach) / 2 : 0;
  scene.base = {margin + room - left * scene.pixels_per_unit, static_cast<float>(height) - room};
  const double seconds = static_cast<double>(take.frames) / take.rate_hz;
  const double rate = static_cast<double>(pages.frames.size()) / seconds;
  return FlamePages{{.rate_hz = rate, .loop = take.loop, .pivot = scene.base},
                    [=, outlines = std::move(outlines)](std::size_t k) {
                      Image image(width, height);
                      const Flame flame{outlines[k], scene};
                      draw_flames(image, {&flame, 1}, style);
                      make_light(image);
                      fade_edges(room, image);
                      return image;
                    }};
}

constexpr int kFilmHeight = 256, kLottieHeight = 512, kAtlasColumns = 8, kAtlasSize = 1024;

struct Job {
  const Model& model;
  const Arguments& arguments;
  Terminal& terminal;
  std::string path;
  std::size_t frames = 0;  // number of frames to write
};

int given(const Job& job, const char* flag, int fallback) {
  return job.arguments.has(flag) ? job.arguments.integer(flag) : fallback;
}

Result<void> write_gltf(Job& job, const Take& taken) {
  const auto bytes = gltf_bytes(job.model, taken);
  if (!bytes) return bytes.error();
  return write_file(job.path, *bytes);
}

Result<void> write_lottie(Job& job, const Take& taken) {
  const auto text = lottie_text(job.model, taken, given(job, "size", kLottieHeight));
  if (!text) return text.error();
  return write_file(job.path, *text);
}

Result<void> write_pictures(Job& job, const Take& taken) {
  const bool atlas = job.path.ends_with(".png");
  const int columns = given(job, "columns", kAtlasColumns), size = given(job, "size", kAtlasSize);
  if (atlas && (columns < 1 || columns > 64)) return Error{"--columns is not 1 to 64"};
  auto count = atlas ? static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns) : taken.frames;
  if (given(job, "frames", 1) < 1) return Error{"--frames is 0, expected at least 1"};
  if (job.arguments.has("frames")) count = static_cast<std::size_t>(job.arguments.integer("frames"));
  Pages pages{{}, atlas ? size / columns : given(job, "size", kFilmHeight), atlas ? size / columns : 0};
  job.frames = count = std::min(count, taken.frames);
  for (std::size_t k = 0; k < count; ++k) pages.frames.push_back(k * taken.frames / count);
  auto made = flame_pages(job.model, taken, pages);
  if (!made) return made.error();
  const auto draw = [&](std::size_t k) {
    job.terminal.progress("drawing", static_cast<double>(k + 1) / static_cast<double>(count));
    return made->draw(k);
  };
  if (!atlas) return write_animation(job.path, made->book, count, draw);
  for (std::size_t k = 0; k < count; ++k) made->book.frames.push_back(draw(k));
  made->book.columns = columns;
  return write_atlas(job.path, made->book);
}

// Writes OUT.vat.png and OUT.vat.json.
Result<void> write_vertices(Job& job, const Take& taken) {
  const auto made = vertex_animation(job.model, taken);
  if (!made) return made.error();
  Image texture(static_cast<int>(made->columns), static_cast<int>(made->rows));
  for (std::size_t k = 0; k < texture.pixels().size(); ++k) {
    const std::uint8_t* rgb = &made->rgb[3 * k];
    texture.pixels()[k] = 0xff000000U | static_cast<std::uint32_t>(rgb[0] << 16 | rgb[1] << 8 | rgb[2]);
  }
  if (auto ok = write_png(job.path, texture); !ok) return ok;
  return write_file(std::filesystem::path(job.path).replace_extension(".json"), made->json);
}

// Writes source text to the job's file NAME.c (.m, .py, .json) and, unless `declared` is empty, `declared` to NAME.h.
Result<void> write_source(const std::string& text, const std::string& declared, const std::string& what, const Job& job,
                          Terminal& terminal) {
  const std::string header = std::filesystem::path(job.path).replace_extension(".h").string();
  if (!declared.empty()) {
    if (auto ok = write_file(header, declared); !ok) return ok;
  }
  if (auto ok = write_file(job.path, text); !ok) return ok;
  terminal.add("output", job.path);
  terminal.say("wrote " + job.path + (declared.empty() ? "" : " and " + header) + ": " + what + ", " +
               shown(job.model.rate_hz, 5) + " steps a second");
  return {};
}

// Writes the model itself as code: a lamp in fixed point, or a linear system.
Result<void> write_model_source(const Job& job, std::optional<PlantLanguage> language, Terminal& terminal) {
  const std::string name = std::filesystem::path(job.path).stem().string();
  if (language) {
    const auto plant = plant_text(job.model, *language, name);
    if (!plant) return Error{job.path + ": " + plant.error().message};
    if (const Usable& use = job.model.training.usable; !use.verdict) terminal.warn("not usable: " + use.reason);
    return write_source(plant->text, plant->header, "a linear system", job, terminal);
  }
  const auto lamp = firmware_source(job.model, name);
  if (!lamp) return Error{job.path + ": " + lamp.error().message};
  terminal.add("state_bytes", lamp->state_bytes);
  return write_source(lamp->source, lamp->header, std::to_string(lamp->state_bytes) + " bytes of state a lamp", job,
                      terminal);
}

// Returns the language of a linear system by the file's extension. None for .c or .json unless the model is a plant, an
// ARX model with inputs and plain outputs: other models become a lamp's .c or an animation's .json.
std::optional<PlantLanguage> plant_language(const Model& model, const std::string& extension) {
  const bool plant = std::holds_alternative<ArxModel>(model.dynamics) && !model.inputs.empty() &&
                     std::holds_alternative<PlainView>(model.view);
  if (extension == ".m") return PlantLanguage::kOctave;
  if (extension == ".py") return PlantLanguage::kPython;
  if (plant && extension == ".json") return PlantLanguage::kJson;
  return plant && extension == ".c" ? std::optional(PlantLanguage::kC) : std::nullopt;
}

// Reports flags without effect as errors, since the user expects an effect.
Result<void> check_flags(const Arguments& arguments, std::string extension, bool is_source) {
  if (arguments.text("output").ends_with(".vat.png")) extension = ".vat.png";
  const std::string nothing = "does nothing to a " + extension + " file, which ";
  if (is_source) {
    const auto why = nothing + "is the model itself and plays for ever";
    auto ok = refuse(arguments, {"seconds", "loop", "wind", "noise", "size", "seed", "input", "frames"}, why);
    if (!ok) return ok;
  }
  if (extension != ".png") {
    if (auto ok = refuse(arguments, {"columns"}, nothing + "is no atlas"); !ok) return ok;
  }
  auto whole =
      refuse(arguments, {"seconds", "loop", "columns"}, "does not go with --input, which is played once, whole");
  if (arguments.has("input") && !whole) return whole;
  if (extension == ".glb" || extension == ".vat.png" || extension == ".json") {
    if (auto ok = refuse(arguments, {"frames"}, nothing + "holds every frame"); !ok) return ok;
  }
  if (extension == ".vat.png") {
    if (auto ok = refuse(arguments, {"size"}, nothing + "has a column a corner and a row a frame"); !ok) return ok;
  }
  if (extension == ".glb") return refuse(arguments, {"size"}, nothing + "is in metres");
  return refuse(arguments, {"instances"}, nothing + "holds one");
}

Result<void> run_export(const Arguments& arguments, Terminal& terminal) {
  static const std::map<std::string, Result<void> (*)(Job&, const Take&)> writers = {
      {".glb", write_gltf},      {".json", write_lottie},   {".png", write_pictures},
      {".apng", write_pictures}, {".webm", write_pictures},
  };
  const std::string& path = arguments.text("output");
  const std::string extension = std::filesystem::path(path).extension().string();
  const auto writer = writers.find(extension);
  const auto write = path.ends_with(".vat.png") ? write_vertices : writer == writers.end() ? nullptr : writer->second;
  const bool script = extension == ".m" || extension == ".py" || extension == ".c";
  if (!write && !script) {
    return Error{path +
                 ": cannot be written, expected a name that ends in .glb, .json, .png, .apng, .webm, .c, .m or .py"};
  }
  const auto model = read_model(arguments.positional());
  if (!model) return model.error();
  const auto language = plant_language(*model, extension);
  if (auto ok = check_flags(arguments, extension, language || script); !ok) return ok;
  Job job{*model, arguments, terminal, path};
  if (language || script) return write_model_source(job, language, terminal);
  const auto taken = take_from(*model, arguments, terminal, write == write_gltf || write == write_vertices);
  if (!taken) return taken.error();
  job.frames = taken->frames;
  if (auto ok = write(job, *taken); !ok)
    return ok.error().message.starts_with(path) ? ok : Error{path + ": " + ok.error().message};
  terminal.add("output", path);
  const double rate = taken->rate_hz * static_cast<double>(job.frames) / static_cast<double>(taken->frames);
  terminal.say("wrote " + path + ": " + std::to_string(job.frames) + " frames at " + shown(rate, 5) + " a second" +
               (taken->loop ? ", a loop" : ""));
  return {};
}

}  // namespace

Command export_command() {
  return {
      "export",
      "Writes a model's play as a file that another tool opens: glTF (.glb), Lottie (.json), a sprite atlas (.png, "
      "with its .atlas.json), APNG or WebM with opacity; or the model itself: a lamp as C for microcontrollers (.c, "
      "with its .h), an ARX model with inputs as a linear system for Octave or MATLAB (.m), SciPy (.py), as .json, or "
      "as its difference equation in C.",
      {{"MODEL", "the model, a .wisp file"}},
      {
          {"output",
           Kind::kOutput,
           "OUT",
           "",
           "what to write: OUT.glb, .json, .png, .vat.png, .apng, .webm, .c, .m or .py",
           {},
           true,
           {},
           {".h", ".atlas.json", ".json"}},
          {"seconds", Kind::kNumber, "S", "4", "how much of its play"},
          loop_flag(),
          {"instances", Kind::kInteger, "K", "1", "how many in one .glb, each with its own chance"},
          {"wind", Kind::kNumber, "W", "0", "a constant value for every input"},
          {"noise", Kind::kChoice, "on|off", "on", "the residual noise", {"on", "off"}},
          {"input", Kind::kPath, "REC", "",
           "a recording or a sound file of blowing in the place of --wind; a flame may go out"},
          {"size", Kind::kInteger, "PIXELS", "",
           "width of an atlas, or height of another picture; default 1024, for APNG and WebM 256, for Lottie 512"},
          {"frames", Kind::kInteger, "N", "", "of pictures, evenly spread; default: columns² in an atlas, else all"},
          {"columns", Kind::kInteger, "N", "", "of an atlas, whose frames are square; default 8"},
          {"seed", Kind::kInteger, "N", "1", "of all chance; the same seed gives the same bytes"},
      },
      {
          {"wisp export leaf.wisp --loop 6 --instances 20 -o leaves.glb", "Twenty leaves that fall for ever"},
          {"wisp export flame.wisp --loop 4 -o flame.glb",
           "A flame as a mesh whose morph targets are the model's outputs"},
          {"wisp export flame.wisp --loop 2 -o flame.png",
           "A sprite atlas for a game: 64 frames in 1024 x 1024, premultiplied; flame.atlas.json says where they are"},
          {"wisp export flame.wisp --loop 4 -o flame.vat.png",
           "A vertex animation texture for crowds, and flame.vat.json"},
          {"wisp export flame.wisp --loop 3 -o flame.json", "The outline as a Lottie animation"},
          {"wisp export dryer.wisp -o dryer.m", "An ARX model as state space and transfer functions for Octave"},
          {"wisp export light.wisp -o candle.c", "A lamp that flickers, in fixed point, for a microcontroller"},
      },
      run_export,
  };
}

}  // namespace wisp::cli
