#include "terminal.hpp"

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <cstdio>

#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"

namespace wisp::cli {

Terminal::Terminal(Options options) : options_(options), terminal_(::isatty(2) != 0) {}

void Terminal::progress(std::string_view what, double done) {
  if (options_.quiet || !terminal_) return;
  constexpr int kWidth = 30;
  const int percent = done < 0 ? -1 : static_cast<int>(100 * std::min(done, 1.0));
  if (bar_shown_ && percent == last_percent_ && what == last_what_) return;
  const auto now = std::chrono::steady_clock::now();
  if (what != last_what_ || percent < last_percent_) begun_ = now;
  last_percent_ = percent;
  last_what_ = what;
  bar_shown_ = true;
  std::string bar;
  for (int k = 0; k < kWidth; ++k) bar += 100 * k < percent * kWidth ? "━" : "╌";
  if (percent < 0) {
    std::fprintf(stderr, "\r\033[K%.*s …", static_cast<int>(what.size()), what.data());
  } else {
    const double passed = std::chrono::duration<double>(now - begun_).count();
    const std::string left =
        passed > 2 && percent > 0 ? ", " + shown(passed * (100 - percent) / percent, 2) + " s left" : std::string();
    std::fprintf(stderr, "\r\033[K%.*s %s %3d %%%s", static_cast<int>(what.size()), what.data(), bar.c_str(), percent,
                 left.c_str());
  }
  std::fflush(stderr);
}

Progress Terminal::progress() {
  return [this](std::string_view stage, double share) {
    progress(stage, share);
    return true;
  };
}

void Terminal::show(const Report& report) {
  for (const std::string& warning : report.warnings) warn(warning);
  Report told = report;
  told.warnings.clear();
  clear_bar();
  if (!options_.json) std::fputs(to_text(told).c_str(), stdout);
  if (told.verdict) result_.verdict = told.verdict;
  result_.append(std::move(told));
}

void Terminal::add(std::string id, ReportValue value) {
  result_.add("").entries.push_back({std::move(id), std::move(value), "", ""});
}

void Terminal::add(ReportTable table) {
  for (ReportSection& section : result_.sections) {
    for (ReportTable& before : section.tables) {
      if (before.id != table.id) continue;
      before.rows.insert(before.rows.end(), table.rows.begin(), table.rows.end());
      return;
    }
  }
  result_.add("").tables.push_back(std::move(table));
}

void Terminal::verdict(const std::string& of, const Report& report) {
  if (!report.verdict) return;
  say(of + ": " + (report.verdict->usable ? "usable: " : "not usable: ") + report.verdict->reason);
}

double Terminal::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

void Terminal::clear_bar() {
  if (bar_shown_) std::fputs("\r\033[K", stderr);
  bar_shown_ = false;
}

void Terminal::warn(std::string_view text) {
  clear_bar();
  result_.warnings.emplace_back(text);
  std::fprintf(stderr, "wisp: warning: %.*s\n", static_cast<int>(text.size()), text.data());
}

void Terminal::say(std::string_view text) {
  if (options_.json) return;
  clear_bar();
  std::fprintf(stdout, "%.*s\n", static_cast<int>(text.size()), text.data());
}

void Terminal::finish() {
  clear_bar();
  if (!options_.json) return;
  std::fprintf(stdout, "%s\n", to_json(result_, 1).c_str());
}

void Terminal::fail(std::string_view message) {
  clear_bar();
  std::fprintf(stderr, "wisp: %.*s\n", static_cast<int>(message.size()), message.data());
  // The JSON document keeps the results from before the failure.
  add("error", std::string(message));
  finish();
}

std::string shown(double value, int digits) { return wisp::shown(ReportValue(value), digits); }

}  // namespace wisp::cli
