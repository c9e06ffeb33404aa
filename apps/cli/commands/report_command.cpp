// `wisp report`: a model and its validation on recordings, as one page.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <span>
#include <system_error>

#include "commands/commands.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

// A part of the page: heading, report, and pictures below it (.svg and .png files).
struct PagePart {
  std::string title;
  Report report;
  std::vector<std::filesystem::path> pictures{};
};

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 3rem; border-top: 1px solid #ccc; padding-top: 1.5rem; }
.verdict { font-weight: 600; padding: .6rem 1rem; border-left: 4px solid; }
.usable { color: #22682d; background: #eef7ef; } .refused { color: #9a2a1c; background: #fbeeec; }
.warnings { color: #7a5200; }
table { border-collapse: collapse; margin: .8rem 0; display: block; overflow-x: auto; }
caption { text-align: left; color: #555; }
th, td { text-align: left; vertical-align: top; padding: .2rem .8rem .2rem 0; font-variant-numeric: tabular-nums; }
th { font-weight: 500; } .figures td:last-child { color: #666; }
img { max-width: 100%; display: block; margin: 1rem 0; }
)";

// Encodes bytes as Base64 (RFC 4648, section 4).
std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      word = word << 8 | (k + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      out += k + i > bytes.size() ? '=' : kDigits[word >> (18 - 6 * i) & 63];
    }
  }
  return out;
}

// Embeds a picture as a separate document, so that the element ids of two SVG pictures do not collide.
Result<std::string> picture_of(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  const char* type = path.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return "<img alt=\"" + html_escaped(path.stem().string()) + "\" src=\"data:" + type + ";base64," + base64(*bytes) +
         "\">\n";
}

// Returns the page as HTML with embedded pictures. Errors: a picture that cannot be read.
Result<std::string> report_page(const std::string& title, const std::vector<PagePart>& parts) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      html_escaped(title) + "</title>\n<style>" + kStyle + "</style>\n<h1>" + html_escaped(title) + "</h1>\n";
  for (const PagePart& part : parts) {
    out += "<h2>" + html_escaped(part.title) + "</h2>\n" + to_html(part.report);
    for (const std::filesystem::path& path : part.pictures) {
      const auto picture = picture_of(path);
      if (!picture) return picture.error();
      out += *picture;
    }
  }
  return out + "</html>\n";
}

namespace fs = std::filesystem;

// Name of a temporary folder for pictures; the destructor removes the folder.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("wisp-report-" + std::to_string(std::random_device{}()))) {}
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Returns the pictures below a folder: all .svg files, and .png files without an .svg of the same name (film strips).
std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> pictures;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    const fs::path& path = entry.path();
    fs::path vectors = path;
    vectors.replace_extension(".svg");
    if (path.extension() == ".svg" || (path.extension() == ".png" && !fs::exists(vectors))) pictures.push_back(path);
  }
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

// Validates a model on a recording as `wisp validate` does, with the pictures in `folder`.
Result<PagePart> judged(const Model& model, const std::string& recording, const fs::path& folder,
                        const Arguments& arguments) {
  Arguments asked = arguments;
  asked.set_positionals({arguments.positional(), recording});
  if (!std::holds_alternative<SwitchedArxModel>(model.dynamics)) asked.set("figures", folder.string());
  if (std::holds_alternative<OutlineView>(model.view)) asked.set("film-strip", (folder / "a-film-strip.png").string());
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{folder.string() + ": cannot be made for the report's pictures: " + error.message()};
  Terminal unseen({.json = true, .quiet = true});
  if (auto ok = validate_command().run(asked, unseen); !ok) return ok.error();
  return PagePart{"On " + fs::path(recording).filename().string(), std::move(unseen.result()), pictures_in(folder)};
}

Result<void> run_report(const Arguments& arguments, Terminal& terminal) {
  const fs::path output = arguments.text("output");
  if (output.extension() != ".html" && output.extension() != ".htm") {
    return Error{"--output " + output.string() + ": a report is a page, expected a name that ends in .html"};
  }
  const auto model = read_model(arguments.positional());
  if (!model) return model.error();
  auto facts = model_report(*model);
  if (!facts) return facts.error();
  std::vector<PagePart> parts;
  parts.push_back({"The model", std::move(*facts)});
  const Scratch scratch;
  const auto& positionals = arguments.positionals();
  for (std::size_t k = 1; k < positionals.size(); ++k) {
    auto part = judged(*model, positionals[k], scratch.path() / std::to_string(k), arguments);
    if (!part) return part.error();
    parts.push_back(std::move(*part));
  }
  const auto page = report_page(fs::path(arguments.positional()).filename().string(), parts);
  if (!page) return page.error();
  if (auto ok = write_file(output, *page); !ok) return ok.error();
  for (const PagePart& part : parts) {
    terminal.verdict(part.title, part.report);
    if (part.report.verdict) terminal.result().verdict = part.report.verdict;
  }
  terminal.add("recordings", positionals.size() - 1);
  terminal.add("bytes", page->size());
  terminal.say("wrote " + output.string());
  return {};
}

}  // namespace

Command report_command() {
  std::vector<Flag> flags = {
      {"output", Kind::kOutput, "REPORT.html", "", "the page to write", {}, true},
  };
  // Recordings are judged as by `validate`, with the same flags.
  for (Flag& flag : validate_command().flags) {
    if (flag.kind != Kind::kOutput) flags.push_back(std::move(flag));
  }
  return {
      "report",
      "Writes one self-contained page: what a model is, and how it stands up to recordings, with figures.",
      {{"MODEL", "the model, a .wisp file"},
       {"REC_OR_CLIP", "recordings (.csv) or clips that it is judged on, as by `wisp validate`", true, true}},
      std::move(flags),
      {{"wisp report flame.wisp -o flame.html", "What the model is, and how it was made"},
       {"wisp report dryer.wisp hairdryer.csv --dt 0.08 --range 501:1000 -o dryer.html",
        "With how it does on rows that it has not seen"}},
      run_report,
  };
}

}  // namespace wisp::cli
