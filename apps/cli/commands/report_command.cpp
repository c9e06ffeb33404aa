// `wisp report`: a model, and how it stands up to recordings, as one page.

#include <algorithm>
#include <system_error>

#include "commands/commands.hpp"
#include "reports/report_page.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/model/file.hpp"

#ifdef _WIN32
#include <process.h>
#define getpid _getpid
#else
#include <unistd.h>
#endif

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

// A folder for pictures, gone with what it was for.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("wisp-report-" + std::to_string(::getpid()))) {}
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

// Plots are vectors; of what has no vectors, as a film strip, the pixels.
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

// What `wisp validate` says of a recording, and its pictures in a folder.
Result<PagePart> judged(const Model& model, const std::string& recording, const fs::path& folder,
                        const Arguments& arguments) {
  Arguments asked = arguments;
  asked.set_positionals({arguments.positional(), recording});
  asked.set("figures", folder.string());
  if (std::holds_alternative<OutlineView>(model.view)) asked.set("film-strip", (folder / "a-film-strip.png").string());
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{folder.string() + ": cannot be made for the report's pictures: " + error.message()};
  Terminal unseen({.json = true, .quiet = true});
  if (auto ok = validate_command().run(asked, unseen); !ok) return ok.error();
  return PagePart{"On " + fs::path(recording).filename().string(), std::move(unseen.result()), pictures_in(folder)};
}

Result<void> run_report(const Arguments& arguments, Terminal& terminal) {
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
  const fs::path output = arguments.text("output");
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
  // What is said of a recording is what `validate` says, asked in the same way.
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
